// SPDX-License-Identifier: Apache-2.0
#include <vmlight/export/target.h>

#include <algorithm>

namespace vmlight {
namespace {

constexpr OcclusionLayout kGray { "ao", 1, 0, {} };
// HDRP's mask map: metallic, occlusion, detail mask, smoothness. No metal, no detail, smoothness as HDRP expects it.
constexpr OcclusionLayout kMaskMap { "mask_map", 4, 1, { 0, 0, 0, 0.5f } };

} // namespace

const std::vector<ExportTarget>& export_targets()
{
    constexpr bool kUp = true, kDown = false;
    static const std::vector<ExportTarget> targets {
        { "godot", "Godot 4: AO in red, bent normal in red and green", kGray, BentNormalSlot::Tangent, kUp },
        { "unity", "Unity HDRP: AO in green of the mask map, bent normal", kMaskMap, BentNormalSlot::TangentOrObject,
          kUp },
        { "unreal", "Unreal Engine: AO, bent normal with green down", kGray, BentNormalSlot::TangentOrObject, kDown },
        { "substance", "Substance 3D, by its defaults: AO, bent normal with green down", kGray,
          BentNormalSlot::TangentOrObject, kDown },
        { "filament", "Filament: AO, bent normal", kGray, BentNormalSlot::Tangent, kUp },
        { "three", "three.js: AO in red", kGray, BentNormalSlot::None, kUp },
        { "gltf", "glTF 2.0: AO in red", kGray, BentNormalSlot::None, kUp },
    };
    return targets;
}

const ExportTarget* find_export_target(const std::string& name)
{
    const auto& targets = export_targets();
    const auto found
        = std::find_if(targets.begin(), targets.end(), [&](const ExportTarget& target) { return name == target.name; });
    return found == targets.end() ? nullptr : &*found;
}

Choices export_target_choices()
{
    Choices choices;
    for (const ExportTarget& target : export_targets())
        choices.choices.push_back({ target.name, target.meaning });
    return choices;
}

} // namespace vmlight
