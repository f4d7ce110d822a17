// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace vmlight::view {

class App;

/// The sliders, the texel under the mouse, the line between two models, and the status line.
void draw_panels(App& app);

} // namespace vmlight::view
