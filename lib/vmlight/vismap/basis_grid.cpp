// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/basis_grid.h>

#include <vmlight/image/channels.h>
#include <vmlight/math/packed_visibility.h>

namespace vmlight {
namespace {

using Pack = void (VisibilityGrid::*)(float* packed, const Imath::V3d& normal, const Imath::V3d& surface) const;

template <Pack kPack> class GridAccumulator : public BasisAccumulator
{
public:
    void project(const TexelRays& rays, float* dst) override
    {
        m_grid.set_rays(rays.fan, rays.traced);
        (m_grid.*kPack)(dst, Imath::V3d(rays.normal), Imath::V3d(rays.geometric_normal));
    }

private:
    VisibilityGrid m_grid;
};

} // namespace

std::vector<std::string> mask_channels(const VismapParams&)
{
    return numbered_channels("mask", 0, kMaskFloats);
}

std::vector<std::string> cells_channels(const VismapParams&)
{
    return numbered_channels("cells", 0, kCellsFloats);
}

std::unique_ptr<BasisAccumulator> make_mask_accumulator(const VismapParams&)
{
    return std::make_unique<GridAccumulator<&VisibilityGrid::mask>>();
}

std::unique_ptr<BasisAccumulator> make_cells_accumulator(const VismapParams&)
{
    return std::make_unique<GridAccumulator<&VisibilityGrid::cells>>();
}

} // namespace vmlight
