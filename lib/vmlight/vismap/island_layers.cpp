// SPDX-License-Identifier: Apache-2.0
#include <vmlight/vismap/island_layers.h>

#include <vmlight/vismap/neighbour_weights.h>

#include <algorithm>

namespace vmlight {
namespace {

// Each costs up to as much as the whole tile.
constexpr size_t kMostLayers = 32;

struct IslandBox
{
    uint32_t island;
    std::pair<size_t, size_t> continuations;
    int left = kTileSize, right = -1, top = kTileSize, bottom = -1; // of its texels in the tile
    size_t layer = 0;

    // Whether a cell exists that both may read.
    bool is_near(const IslandBox& other) const
    {
        constexpr int kApart = 2 * NeighbourWindow::kHalo;
        return left <= other.right + kApart && other.left <= right + kApart && top <= other.bottom + kApart
            && other.top <= bottom + kApart;
    }
};

// By island.
std::vector<IslandBox> find_boxes(const std::vector<Continuation>& continuations)
{
    std::vector<IslandBox> boxes;
    for (size_t first = 0, last = 0; first < continuations.size(); first = last) {
        while (last < continuations.size() && continuations[last].island == continuations[first].island)
            ++last;
        boxes.push_back({ continuations[first].island, { first, last } });
    }
    std::sort(boxes.begin(), boxes.end(), [](const IslandBox& a, const IslandBox& b) { return a.island < b.island; });
    return boxes;
}

} // namespace

std::vector<IslandLayer> layers_of_islands(const std::vector<uint32_t>& islands,
                                           const std::vector<Continuation>& continuations)
{
    std::vector<IslandBox> boxes = find_boxes(continuations);
    const auto find = [&](uint32_t island) -> IslandBox* {
        const auto box = std::lower_bound(boxes.begin(), boxes.end(), island,
                                          [](const IslandBox& a, uint32_t b) { return a.island < b; });
        return box != boxes.end() && box->island == island ? &*box : nullptr;
    };
    for (int i = 0; i < kTileSize * kTileSize && !boxes.empty(); ++i)
        if (islands[size_t(i)] != kNoIsland)
            if (IslandBox* box = find(islands[size_t(i)])) {
                box->left = std::min(box->left, i % kTileSize), box->right = std::max(box->right, i % kTileSize);
                box->top = std::min(box->top, i / kTileSize), box->bottom = std::max(box->bottom, i / kTileSize);
            }
    std::vector<IslandLayer> layers(1);
    std::vector<std::vector<const IslandBox*>> members(1);
    for (IslandBox& box : boxes) {
        if (box.right < 0)
            continue;
        for (box.layer = 1; box.layer < layers.size(); ++box.layer)
            if (std::none_of(members[box.layer].begin(), members[box.layer].end(),
                             [&](const IslandBox* other) { return box.is_near(*other); }))
                break;
        if (box.layer == kMostLayers) {
            box.layer = 0;
            continue;
        }
        if (box.layer == layers.size()) {
            layers.emplace_back();
            members.emplace_back();
        }
        members[box.layer].push_back(&box);
        layers[box.layer].continuations.push_back(box.continuations);
    }
    for (size_t i = 0; i < islands.size(); ++i)
        if (islands[i] != kNoIsland) {
            const IslandBox* box = find(islands[i]);
            layers[box ? box->layer : 0].texels[i / kTileSize] |= uint64_t(1) << i % kTileSize;
        }
    return layers;
}

} // namespace vmlight
