// SPDX-License-Identifier: Apache-2.0
/// The kernels that an environment is filtered by. A kernel is one row of the table in filter_kernel.cpp.
#pragma once

#include <vmlight/cfem/exact.h>

#include <OpenImageIO/span.h>

#include <string>
#include <vector>

namespace vmlight {

struct FilterKernel
{
    /// The word for CfemParams::kernel, and a phrase for help texts.
    const char *name, *phrase;
    /// The factor of band l in the harmonics of the result.
    double (*eigenvalue)(int band);
    /// CfemParams::filter `exact`: filter the rows of `read`. False if `read` or `progress` stopped it.
    bool (*filter)(std::vector<double>& rgb, const Size& resolution, const EnvironmentGrid& grid, const ReadRow& read,
                   int nthreads, const Progress& progress);
};

/// The table.
OIIO::cspan<FilterKernel> filter_kernels();
/// The kernel of that name, nullptr if there is none.
const FilterKernel* find_filter_kernel(const std::string& name);

} // namespace vmlight
