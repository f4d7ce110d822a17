// SPDX-License-Identifier: Apache-2.0
/// How much of a neighbouring texel goes into a texel: a vector kernel of reconstruction.
#pragma once

#include <vmlight/vismap/neighbour_window.h>

namespace vmlight {

/// Fit the neighbours of each wanted texel, and weigh them by how alike the patches around both are, beyond what their
/// variance and the slope explain, by normals and distance on the surface. How much more two may differ depends on
/// whether all around the texel do (neighbour_fit.h). Where neighbours differ by more than chance and are on no slope,
/// a weight is exactly 0. Where they are on one, all that are near tell the slope, and the weights take the mean at the
/// texel itself: their mean step, each by its weight, is 0 as far as the slope is kept. Source: A. Buades, B. Coll,
/// J.-M. Morel, "A non-local algorithm for image denoising", CVPR 2005; with the variance of F. Rousselle, C. Knaus, M.
/// Zwicker, "Adaptive rendering with non-local means filtering", TOG 31(6), 2012; and the first order of B. Moon, N.
/// Carr, S.-E. Yoon, "Adaptive rendering based on weighted local regression", TOG 33(5), 2014.
void weigh_neighbours(NeighbourWindow& window);

} // namespace vmlight
