// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vmlight::view {

class App;

/// The menu bar, and the keys that stand for its entries.
void draw_menus(App& app);

} // namespace vmlight::view
