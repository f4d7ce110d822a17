// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/filter_kernel.h>

#include <vmlight/cfem/cfem.h>
#include <vmlight/cfem/spherical_harmonics.h>
#include <vmlight/image/channels.h>
#include <vmlight/math/harmonics.h>

namespace vmlight {
namespace {

// Band 2n of the sine weighs about 1 / (2 pi n^3): what is cut off is at most .8 % of the kernel's peak, where it has a
// kink, at the tangent.
constexpr int kSineBands = 128;

bool filter_cosine(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, const ReadRow& read,
                   int nthreads, const Progress& progress)
{
    return filter_exact(rgb, resolution, grid, read, nthreads, progress);
}

bool filter_sine(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, const ReadRow& read,
                 int nthreads, const Progress& progress)
{
    return filter_harmonics(rgb, resolution, kSineBands, grid, read, nthreads, progress, sine_eigenvalue);
}

constexpr FilterKernel kKernels[] = {
    { kCosineKernel, "(1/pi) max(0, cos): for the normals of surfaces", cosine_eigenvalue, filter_cosine },
    { kStrandKernel, "(1/pi^2) sin: for the tangents of strands", sine_eigenvalue, filter_sine },
};

} // namespace

OIIO::cspan<FilterKernel> filter_kernels()
{
    return kKernels;
}

const FilterKernel* find_filter_kernel(const std::string& name)
{
    for (const FilterKernel& kernel : kKernels)
        if (name == kernel.name)
            return &kernel;
    return nullptr;
}

Choices kernel_choices()
{
    Choices choices;
    for (const FilterKernel& kernel : kKernels)
        choices.choices.push_back({ kernel.name, kernel.phrase });
    return choices;
}

} // namespace vmlight
