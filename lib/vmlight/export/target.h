// SPDX-License-Identifier: Apache-2.0
/// The engines that textures are exported for: a table with what each engine's documentation asks for. docs/export.md
/// quotes the pages.
#pragma once

#include <vmlight/base/params.h>

#include <array>
#include <string>
#include <vector>

namespace vmlight {

/// Where an engine looks for ambient occlusion.
struct OcclusionLayout
{
    /// Of the file's name.
    const char* suffix;
    /// Channels of the texture where there is no texture to pack into, and which of them holds the occlusion.
    int channels, channel;
    /// What the other channels hold then.
    std::array<float, 4> others;
};

enum class BentNormalSlot
{
    None, ///< the engine has no such texture
    Tangent,
    TangentOrObject
};

struct ExportTarget
{
    const char *name, *meaning;
    OcclusionLayout occlusion;
    BentNormalSlot bent_normal;
    /// Whether the green channel of a tangent-space normal is up in the texture (OpenGL), or down (DirectX).
    bool green_is_up;
};

const std::vector<ExportTarget>& export_targets();

/// nullptr if there is no target of that name.
const ExportTarget* find_export_target(const std::string& name);

/// The names and meanings of all targets.
Choices export_target_choices();

} // namespace vmlight
