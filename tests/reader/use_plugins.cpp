// SPDX-License-Identifier: Apache-2.0
// Only these tests read recipes through the plugins; others have the readers in their own process, and count their
// work.
#include <OpenImageIO/imageio.h>

namespace {

const bool is_set = OIIO::attribute("plugin_searchpath", VMLIGHT_TEST_PLUGINS);

} // namespace
