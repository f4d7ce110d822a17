// SPDX-License-Identifier: Apache-2.0
#include "readers.h"

#include <vmlight/stage/reader.h>

OIIO::ImageInput* vmlight_create_reader(const char* stage)
{
    return new vmlight::StageInput(stage);
}
