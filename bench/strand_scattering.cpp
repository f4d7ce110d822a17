// SPDX-License-Identifier: Apache-2.0
// How much light strands send each other, which vmlight leaves out: for each sky, and strands of albedo .2, .5 and .8
// that scatter as Kajiya and Kay's diffuse term does, the light at every STEP-th texel that has met another strand
// before, by path tracing. Bodies are black. Skies are reduced to 512x256.
//     strand_scattering HAIR RADIUS OCCLUDER STEP PATHS SKY...
#include "strand_texels.h"

#include <vmlight/base/oiio_compat.h>
#include <vmlight/math/latlong.h>
#include <vmlight/trace/curves.h>
#include <vmlight/trace/embree_scene.h>
#include <vmlight/trace/strand_scene.h>

#include <OpenImageIO/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

using namespace vmlight;
using Imath::V3d;
using Imath::V3f;

namespace {

constexpr int kWidth = 512, kHeight = 256;
constexpr int kMostBounces = 64;
constexpr double kAlbedos[] = { 0.2, 0.5, 0.8 };
constexpr unsigned kStrands = 0, kBody = 1; // geometries

[[noreturn]] void fail(const std::string& reason)
{
    std::fprintf(stderr, "strand_scattering ERROR: %s\n", reason.c_str());
    std::exit(1);
}

using Random = std::mt19937;

double share(Random& random)
{
    return std::uniform_real_distribution<double>()(random);
}

// A point on the axis of a strand, in the scene.
struct Place
{
    V3f position;
    V3d tangent;
    float radius;
    uint32_t strand;
};

/// A sky from which directions are drawn by their light.
class Sky
{
public:
    explicit Sky(const std::string& path)
    {
        OIIO::ImageBuf image;
        if (!oiio::resize(image, OIIO::ImageBuf(path), OIIO::ROI(0, kWidth, 0, kHeight, 0, 1, 0, 3), 0, "box"))
            fail(image.geterror());
        std::vector<double> light;
        for (int i = 0; i < kWidth * kHeight; ++i) {
            float rgb[3];
            image.getpixel(i % kWidth, i / kWidth, rgb, 3);
            const double grey = std::max(0.0, (double(rgb[0]) + double(rgb[1]) + double(rgb[2])) / 3);
            light.push_back(grey * latlong::row_solid_angle(i / kWidth, kHeight) / kWidth);
            m_power += light.back();
        }
        m_pixels = std::discrete_distribution<int>(light.begin(), light.end());
    }

    double power() const { return m_power; }
    V3d draw(Random& random)
    {
        const int pixel = m_pixels(random), y = pixel / kWidth;
        const double top = std::cos(latlong::pi * y / kHeight), bottom = std::cos(latlong::pi * (y + 1) / kHeight);
        const double theta = std::acos(top + (bottom - top) * share(random)); // even in area
        return latlong::direction((pixel % kWidth + share(random)) / kWidth, theta / latlong::pi);
    }

private:
    double m_power = 0;
    std::discrete_distribution<int> m_pixels;
};

// By the sine of the angle to the tangent.
V3d draw_scattered(const V3d& tangent, Random& random)
{
    for (;;) {
        const double z = 2 * share(random) - 1, turn = 2 * latlong::pi * share(random), r = std::sqrt(1 - z * z);
        const V3d w(r * std::cos(turn), r * std::sin(turn), z);
        if (share(random) < w.cross(tangent).length())
            return w;
    }
}

void pass_own_strand(const RTCFilterFunctionNArguments* arguments)
{
    const auto* const strand_of = static_cast<const uint32_t*>(arguments->geometryUserPtr);
    for (unsigned i = 0; i < arguments->N; ++i)
        if (arguments->valid[i]
            && strand_of[RTCHitN_primID(arguments->hit, arguments->N, i)]
                == static_cast<embree::QueryContext*>(arguments->context)->own_strand)
            arguments->valid[i] = 0;
}

/// What rays meet: which strand, and where.
class Hits
{
public:
    Hits(const Strands& strands, const Mesh& body, const SceneFrame& frame)
        : m_device(rtcNewDevice("set_affinity=0"))
        , m_scene(rtcNewScene(m_device))
    {
        std::string error;
        if (!m_curves.add(strands, frame, CurveShape::round, 0, error))
            fail(error);
        rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
        embree::attach_curves(m_device, m_scene, m_curves, CurveShape::round, kStrands,
                              const_cast<uint32_t*>(m_curves.strand_of().data()), nullptr);
        rtcSetGeometryIntersectFilterFunction(rtcGetGeometry(m_scene, kStrands), pass_own_strand);
        rtcCommitGeometry(rtcGetGeometry(m_scene, kStrands));
        RTCGeometry triangles = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* const vertices = static_cast<V3f*>(rtcSetNewGeometryBuffer(
            triangles, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(V3f), body.positions.size()));
        for (size_t v = 0; v < body.positions.size(); ++v)
            vertices[v] = frame.to_scene(body.positions[v]);
        rtcSetSharedGeometryBuffer(triangles, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, body.triangles.data(), 0, 12,
                                   body.triangles.size());
        rtcCommitGeometry(triangles);
        rtcAttachGeometryByID(m_scene, triangles, kBody);
        rtcReleaseGeometry(triangles);
        rtcCommitScene(m_scene);
    }
    ~Hits()
    {
        rtcReleaseScene(m_scene);
        rtcReleaseDevice(m_device);
    }
    Hits(const Hits&) = delete;
    Hits& operator=(const Hits&) = delete;

    // False if the ray leaves, or meets the body.
    bool next(Place& place, const V3d& direction) const
    {
        RTCRayHit8 ray {};
        alignas(32) int valid[8] = { -1, 0, 0, 0, 0, 0, 0, 0 };
        ray.ray.org_x[0] = place.position.x, ray.ray.org_y[0] = place.position.y, ray.ray.org_z[0] = place.position.z;
        ray.ray.dir_x[0] = float(direction.x), ray.ray.dir_y[0] = float(direction.y);
        ray.ray.dir_z[0] = float(direction.z);
        ray.ray.tnear[0] = place.radius;
        ray.ray.tfar[0] = std::numeric_limits<float>::infinity();
        ray.ray.mask[0] = ~0u;
        ray.hit.geomID[0] = ray.hit.instID[0][0] = RTC_INVALID_GEOMETRY_ID;
        embree::Query query;
        query.pass_strand(place.strand);
        query.intersect8(valid, m_scene, ray);
        if (ray.hit.geomID[0] != kStrands)
            return false;
        place = at(ray.hit.primID[0], double(ray.hit.u[0]));
        return true;
    }

private:
    // Of a uniform cubic B-spline.
    Place at(unsigned span, double u) const
    {
        const double v = 1 - u;
        const std::array<double, 4> weights { v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
                                              (3 * v * v * v - 6 * v * v + 4) / 6, u * u * u / 6 };
        const std::array<double, 4> slopes { -v * v / 2, (3 * u * u - 4 * u) / 2, -(3 * v * v - 4 * v) / 2, u * u / 2 };
        V3d position(0), tangent(0);
        double radius = 0;
        for (size_t k = 0; k < 4; ++k) {
            const auto& c = m_curves.controls()[m_curves.spans()[span] + k];
            const V3d p(V3f(c[0], c[1], c[2]));
            position += p * weights[k];
            tangent += p * slopes[k];
            radius += double(c[3]) * weights[k];
        }
        return { V3f(position), tangent.normalized(), float(radius), m_curves.strand_of()[span] };
    }

    Curves m_curves;
    RTCDevice m_device;
    RTCScene m_scene;
};

/// Light by how often it has met a strand before the one that is looked at.
using Orders = std::array<double, kMostBounces + 1>;

Orders light_at(const Place& start, int paths, const StrandScene& scene, const Hits& hits, Sky& sky, Random& random)
{
    Orders light {};
    RayFan fan(8);
    for (int path = 0; path < paths; ++path) {
        Place place = start;
        for (double& order : light) {
            const V3d w = sky.draw(random);
            fan.x[0] = float(w.x), fan.y[0] = float(w.y), fan.z[0] = float(w.z);
            fan.lanes[0] = 1;
            scene.clear_blocked(fan, place.position, place.radius, place.strand,
                                std::numeric_limits<float>::infinity());
            if (fan.lanes[0])
                order += sky.power() * w.cross(place.tangent).length() / (latlong::pi * latlong::pi) / paths;
            if (!hits.next(place, draw_scattered(place.tangent, random)))
                break;
        }
    }
    return light;
}

double sum_of(const Orders& light, double albedo)
{
    double sum = 0, factor = 1;
    for (const double order : light) {
        sum += factor * order;
        factor *= albedo;
    }
    return sum;
}

} // namespace

int main(int argc, const char** argv)
{
    if (argc < 7)
        fail("usage: strand_scattering HAIR RADIUS OCCLUDER STEP PATHS SKY...");
    std::string error;
    StrandTexels some;
    if (!some.read(argv[1], argv[2], argv[3], std::atoi(argv[4]), error))
        fail(error);
    const StrandScene& scene = some.scene;
    const Hits hits(some.strands, some.bodies[0], scene.frame());
    std::vector<Place> places;
    for (const auto& [x, y, strand, point] : some.texels)
        places.push_back({ scene.frame().to_scene(point.position), point.tangent,
                           float(point.radius * scene.frame().scale), uint32_t(strand) });
    std::printf("%zu texels; for each albedo the share of light that single scattering lacks, and the relative RMSE of "
                "the rest scaled by it\n",
                places.size());
    for (int k = 6; k < argc; ++k) {
        Sky sky(argv[k]);
        Random random(1);
        std::vector<std::array<Orders, 2>> light; // two estimates, each with noise of its own
        for (const Place& place : places)
            light.push_back({ light_at(place, std::atoi(argv[5]), scene, hits, sky, random),
                              light_at(place, std::atoi(argv[5]), scene, hits, sky, random) });
        std::printf("%-28s", OIIO::Filesystem::filename(argv[k]).c_str());
        for (const double albedo : kAlbedos) {
            double single = 0, all = 0, squares = 0;
            for (const auto& two : light)
                for (const Orders& one : two) {
                    single += one[0];
                    all += sum_of(one, albedo);
                }
            const double gain = all / single;
            for (const auto& two : light)
                squares += (sum_of(two[0], albedo) - gain * two[0][0]) * (sum_of(two[1], albedo) - gain * two[1][0]);
            const double mean = all / double(2 * light.size());
            std::printf("   %.1f: %.3f %.3f", albedo, 1 - single / all,
                        std::sqrt(std::max(0.0, squares / double(light.size()))) / mean);
        }
        std::printf("\n");
    }
    return 0;
}
