// SPDX-License-Identifier: Apache-2.0
/// What one bounce costs, and how near it is to the traced reference, as a Markdown table.
///
///     bounce_bench [SIDE] MESH...
///
/// The sky is 1 everywhere, so that V is its light and what is measured is the bounce alone; the albedo is 0.7. The
/// error is RMS over the texels, without the noise of the reference (256 pairs of rays), in percent of the mean light;
/// and the mean error.
#include <vmlight/base/format.h>
#include <vmlight/base/stopwatch.h>
#include <vmlight/mesh/import/read_mesh.h>
#include <vmlight/reference/reference.h>
#include <vmlight/vismap/baker.h>
#include <vmlight/vismap/light_transport.h>
#include <vmlight/vismap/point_visibility.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imagebufalgo.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

using namespace vmlight;

namespace {

constexpr float kAlbedo = 0.7f;

[[noreturn]] void fail(const std::string& error)
{
    std::fprintf(stderr, "bounce_bench: %s\n", error.c_str());
    std::exit(1);
}

struct Scene
{
    BakeScenePointer scene;
    VismapParams map;
    OIIO::ImageBuf reference;
    std::vector<float> visibility;
    double bake_seconds = 0;

    Scene(const std::string& path, int side)
    {
        std::string error;
        auto mesh = std::make_shared<Mesh>();
        auto built = std::make_shared<BakeScene>();
        if (!read_mesh(*mesh, path, {}, error) || !built->build(mesh, {}, 0, error))
            fail(error);
        scene = built;
        map.resolution = { side, side };
        map.samples = 1024;
        OIIO::ImageBuf baked, sky(OIIO::ImageSpec(4, 2, 3, OIIO::TypeFloat));
        if (!make_vismap(baked, scene, map, nullptr, 0, {}))
            fail(baked.geterror());
        visibility.resize(size_t(side) * size_t(side));
        OIIO::ROI first = baked.roi();
        first.chend = 1;
        baked.get_pixels(first, OIIO::TypeFloat, visibility.data());
        VismapParams usual = map;
        usual.samples = VismapParams().samples;
        const Stopwatch timer;
        if (!make_vismap(baked, scene, usual, nullptr, 0, {}))
            fail(baked.geterror());
        bake_seconds = timer();
        OIIO::ImageBufAlgo::fill(sky, { 1.0f, 1.0f, 1.0f });
        ReferenceParams params;
        params.samples = 256;
        params.bounce_albedo = double(kAlbedo);
        if (!make_reference(reference, *scene, sky, map, {}, params, 0, {}))
            fail(reference.geterror());
    }
};

void measure(const std::string& name, const Scene& scene, int rays)
{
    LightTransport transport;
    TransportParams params;
    params.rays = rays;
    std::string error;
    const Stopwatch timer;
    if (!transport.prepare(scene.scene, scene.map, scene.visibility, params, error))
        fail(error);
    VismapParams usual = scene.map;
    usual.samples = 64;
    std::vector<float> own, baked, points, light;
    bake_points(baked, *scene.scene, usual, transport.surfaces(), 0);
    const double seconds = timer();
    const size_t channels = point_channels(usual).size();
    for (const float v : scene.visibility)
        own.insert(own.end(), 3, kAlbedo * v);
    for (size_t i = 0; i < transport.points().size(); ++i)
        points.insert(points.end(), 3, kAlbedo * baked[i * channels]);
    double best = 1e9;
    for (int run = 0; run < 5; ++run) {
        const Stopwatch again;
        transport.gather(light, own, points);
        best = std::min(best, again());
    }
    double squares = 0, noise = 0, bias = 0, sum = 0, added = 0, count = 0;
    for (OIIO::ImageBuf::ConstIterator<float> truth(scene.reference); !truth.done(); ++truth) {
        if (truth[6] == 0)
            continue;
        const size_t texel = size_t(truth.y()) * size_t(scene.map.size().width) + size_t(truth.x());
        const double wrong = double(scene.visibility[texel]) + double(light[3 * texel]) - double(truth[0]);
        squares += wrong * wrong;
        noise += double(truth[3]) * double(truth[3]);
        bias += wrong;
        added += double(light[3 * texel]);
        sum += double(truth[0]);
        ++count;
    }
    std::printf("| %s | %d | %.1f %% | %.2f %% | %+.2f %% | %.2f s | %.2f s | %.1f ms | %.1f |\n", name.c_str(), rays,
                100 * added / sum, 100 * std::sqrt(std::max(0.0, squares - noise) / count) / (sum / count),
                100 * bias / sum, scene.bake_seconds, seconds, 1e3 * best, double(transport.bytes()) / count);
}

} // namespace

int main(int argc, char** argv)
{
    const bool has_side = argc > 1 && OIIO::Strutil::string_is_int(argv[1]);
    const int side = has_side ? OIIO::Strutil::stoi(argv[1]) : 128;
    if (argc < (has_side ? 3 : 2))
        fail("usage: bounce_bench [SIDE] MESH...");
    std::printf("| mesh | rays | of the light | error | bias | bake | trace | new light | bytes a texel |\n"
                "|---|---|---|---|---|---|---|---|---|\n");
    for (int i = has_side ? 2 : 1; i < argc; ++i) {
        const Scene scene(argv[i], side);
        const std::string file = OIIO::Filesystem::filename(argv[i]);
        for (const int rays : { 16, 32, 64, 128, 248 })
            measure(file.substr(0, file.find('.')), scene, rays);
    }
    return 0;
}
