// SPDX-License-Identifier: Apache-2.0
/// The end of the process, as the libraries that it has loaded see it.
#pragma once

namespace vmlight {

/// Whether the process, or the host's plugins, are being unloaded. Hosts destroy their image caches after the plugins'
/// libraries are finalised: what is released then must call none of these. Safe at any time, from any thread.
bool is_process_exiting();

} // namespace vmlight
