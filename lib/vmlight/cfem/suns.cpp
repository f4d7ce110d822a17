// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem/suns.h>

#include <vmlight/base/format.h>
#include <vmlight/cfem/radiance.h>
#include <vmlight/cfem/rows.h>
#include <vmlight/cfem/sun_search.h>
#include <vmlight/math/latlong.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>

namespace vmlight {
namespace {

using Imath::V3d;
using latlong::pi;

// Of the map that the search sees.
constexpr int kSearchWidth = 512, kSearchHeight = 256;

// Half the width of the edge of a cut: that of a pixel of this map.
constexpr double kSoftEdge = 0.5 * pi / kSearchHeight;

// The solid angle of a cell and the integral of the direction over it.
struct Cell
{
    double solid_angle;
    V3d moment;
};

Cell cell_of(const EnvironmentGrid& grid, int column, int row)
{
    const double a = grid.row_edge(row), b = grid.row_edge(row + 1);
    const double left = grid.column_edge(column) - pi, right = grid.column_edge(column + 1) - pi; // latlong.h's phi
    const double turn = right - left, middle = 0.5 * (left + right), half = 0.5 * (a + b), height = b - a;
    Cell cell;
    cell.solid_angle = turn * 2 * std::sin(half) * std::sin(0.5 * height);
    // Int sin^2 theta, Int sin theta cos theta.
    const double across = 0.5 * (height - std::cos(a + b) * std::sin(height));
    const double along = 0.5 * std::sin(a + b) * std::sin(height);
    const double chord = 2 * std::sin(0.5 * turn);
    cell.moment = V3d(-std::sin(middle) * chord * across, turn * along, std::cos(middle) * chord * across);
    return cell;
}

// Rows that a cut may reach, as angles from +y.
bool reaches(const SunSplit::Cut& cut, double from, double to)
{
    const double polar = std::acos(std::clamp(cut.centre.y, -1.0, 1.0)),
                 radius = cut.radius + std::max(kSoftEdge, to - from);
    return polar - radius <= to && polar + radius >= from;
}

// Apply the cuts to a row of R, G, B. `take` receives the columns where a cut takes light, and how much.
template <class Take>
void cut_row(float* rgb, const EnvironmentGrid& grid, int row, const std::vector<SunSplit::Cut>& cuts, Take&& take)
{
    const double top = grid.row_edge(row), bottom = grid.row_edge(row + 1);
    const double sine = std::sin(0.5 * (top + bottom)), cosine = std::cos(0.5 * (top + bottom));
    for (size_t k = 0; k < cuts.size(); ++k) {
        const SunSplit::Cut& cut = cuts[k];
        if (!reaches(cut, top, bottom))
            continue;
        // All that the cut takes light from is nearer than this, and most columns are not.
        const double reach = std::min(pi, cut.radius + std::max(kSoftEdge, bottom - top));
        const double least = std::cos(reach) - 1e-9, centre = cut.centre.y * cosine;
        const double across = sine * std::hypot(cut.centre.x, cut.centre.z);
        const double longitude = std::atan2(-cut.centre.x, cut.centre.z) + pi; // that of grid.h
        for (int i = 0; i < grid.width; ++i) {
            float* pixel = rgb + size_t(3) * size_t(i);
            if (pixel[0] <= cut.background[0] && pixel[1] <= cut.background[1] && pixel[2] <= cut.background[2])
                continue;
            const double middle = 0.5 * (grid.column_edge(i) + grid.column_edge(i + 1));
            if (centre + across * std::cos(middle - longitude) < least)
                continue;
            const V3d direction(std::sin(middle) * sine, cosine, -std::cos(middle) * sine);
            const auto excess = cut.apply(pixel, direction, bottom - top);
            if (excess[0] + excess[1] + excess[2] > 0)
                take(k, i, direction, excess);
        }
    }
}

// Of a lat-long map of R, G, B: the sum of all three over the sphere.
double energy_of(const OIIO::ImageBuf& map)
{
    const OIIO::ImageSpec& spec = map.spec();
    const auto* rgb = static_cast<const float*>(map.localpixels());
    double energy = 0;
    for (int j = 0; j < spec.height; ++j) {
        double row = 0;
        for (int k = 0; k < 3 * spec.width; ++k)
            row += double(*rgb++);
        energy += row * latlong::row_solid_angle(j, spec.height) / spec.width;
    }
    return energy;
}

} // namespace

double SunSplit::Cut::share_at(double angle, double height) const
{
    const double edge = std::max(kSoftEdge, 0.5 * height);
    return std::clamp((radius + edge - angle) / (2 * edge), 0.0, 1.0);
}

int SunSplit::Cut::part_of(const V3d& direction) const
{
    if (middle == V3d(0))
        return 0;
    const V3d up(0, 1, 0), side = up.cross(middle);
    // Straight above and below, any two sides will do.
    const V3d right = side.length() > 1e-6 ? side.normalized() : V3d(1, 0, 0);
    return (direction.dot(right) > 0 ? 1 : 0) + (direction.dot(middle.cross(right)) > 0 ? 2 : 0);
}

std::array<double, 3> SunSplit::Cut::apply(float* rgb, const V3d& direction, double height) const
{
    std::array<double, 3> taken {};
    const double part = share_at(2 * std::asin(std::min(1.0, 0.5 * (direction - centre).length())), height);
    for (size_t c = 0; c < 3 && part > 0; ++c)
        if (const float whole = rgb[c]; whole > background[c]) {
            // A difference of floats is exact in double, unless one is 2^29 times the other.
            rgb[c] = std::min(whole, float(double(whole) - part * (double(whole) - double(background[c]))));
            taken[c] = double(whole) - double(rgb[c]);
        }
    return taken;
}

bool is_wide(const Sun& sun)
{
    constexpr double kWide = 5 * pi / 180; // where a light counts half, see SunSplit::find()
    return sun.disc.half_angle > kWide;
}

std::string suns_text(const std::vector<Sun>& suns)
{
    std::string text;
    for (const Sun& sun : suns)
        text += format("{}{:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g} {:.10g}", text.empty() ? "" : "; ",
                       sun.disc.direction.x, sun.disc.direction.y, sun.disc.direction.z, sun.disc.half_angle * 180 / pi,
                       sun.color[0], sun.color[1], sun.color[2]);
    return text;
}

bool parse_suns(std::vector<Sun>& dst, const std::string& text, std::string& error)
{
    std::vector<Sun> suns;
    for (const std::string& part : OIIO::Strutil::splits(text, ";")) {
        std::vector<double> numbers;
        const std::vector<std::string> words = OIIO::Strutil::splits(part);
        for (const std::string& word : words)
            if (OIIO::Strutil::string_is_float(word))
                numbers.push_back(OIIO::Strutil::stod(word));
        const bool good = numbers.size() == 7 && words.size() == 7
            && std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); })
            && std::abs(V3d(numbers[0], numbers[1], numbers[2]).length() - 1) < 1e-3 && numbers[3] >= 0
            && numbers[3] <= 90;
        if (!good) {
            error = format("\"{}\" is not a list of suns: each is x y z, a half angle in degrees and r g b", text);
            return false;
        }
        suns.push_back({ { V3d(numbers[0], numbers[1], numbers[2]).normalized(), numbers[3] * pi / 180 },
                         { numbers[4], numbers[5], numbers[6] } });
    }
    dst = std::move(suns);
    return true;
}

bool SunSplit::find(const Environment& env, bool sanitize, std::string& error, const Progress& progress)
{
    m_suns.clear();
    m_cuts.clear();
    m_sanitize = sanitize;
    m_share = 0;
    EnvironmentRows rows(env, sanitize);
    if (!rows.open()) {
        error = rows.error();
        return false;
    }
    CfemParams small;
    small.resolution = { std::min(kSearchWidth, rows.grid().width), std::min(kSearchHeight, rows.grid().height) };
    small.sanitize = sanitize;
    OIIO::ImageBuf map;
    const auto part = [&](double from, double to) -> Progress {
        return progress ? [=](double done) { return progress(from + (to - from) * done); } : Progress {};
    };
    if (!make_radiance(map, env, small, error, part(0, 0.5)))
        return false;
    m_bad_values = map.spec().get_int_attribute("vmlight:sanitized");
    std::vector<Cut> cuts = search_suns(map);
    if (!cuts.empty() && !measure(env, cuts, error, part(0.5, 1)))
        return false;
    double energy = 0;
    for (const Sun& sun : m_suns)
        energy += pi * (sun.color[0] + sun.color[1] + sun.color[2]);
    m_share = m_suns.empty() ? 0 : std::min(1.0, energy / energy_of(map));
    return true;
}

bool SunSplit::measure(const Environment& env, std::vector<Cut>& cuts, std::string& error, const Progress& progress)
{
    struct Sums
    {
        std::array<double, 3> energy {};
        V3d moment { 0 };
    };
    std::vector<std::array<Sums, Cut::kParts>> sums(cuts.size());
    EnvironmentRows rows(env, m_sanitize);
    bool good = rows.open();
    const EnvironmentGrid grid = rows.grid();
    std::vector<float> rgb(size_t(3) * grid.width);
    for (int j = 0; good && j < grid.height; ++j) {
        good = rows.read(j, rgb.data()) && (!progress || progress(double(j) / grid.height));
        if (!good)
            break;
        const auto add = [&](size_t k, int i, const V3d& direction, const std::array<double, 3>& excess) {
            const Cell cell = cell_of(grid, i, j);
            Sums& part = sums[k][size_t(cuts[k].part_of(direction))];
            for (size_t c = 0; c < 3; ++c)
                part.energy[c] += excess[c] * cell.solid_angle;
            part.moment += cell.moment * ((excess[0] + excess[1] + excess[2]) / 3);
        };
        cut_row(rgb.data(), grid, j, cuts, add);
    }
    if (!good) {
        error = rows.error().empty() ? "interrupted" : rows.error();
        return false;
    }
    for (size_t k = 0; k < cuts.size(); ++k) {
        const size_t before = m_suns.size();
        for (const Sums& part : sums[k]) {
            const double energy = (part.energy[0] + part.energy[1] + part.energy[2]) / 3;
            if (!(energy > 0) || !std::isfinite(energy))
                continue;
            Sun sun;
            sun.disc = { part.moment.normalized(), disc_half_angle(part.moment.length() / energy) };
            for (size_t c = 0; c < 3; ++c)
                sun.color[c] = part.energy[c] / pi;
            m_suns.push_back(sun);
        }
        if (m_suns.size() > before)
            m_cuts.push_back(cuts[k]);
    }
    return true;
}

Environment SunSplit::rest(const Environment& env) const
{
    if (m_suns.empty())
        return env;
    const OIIO::ImageSpec& all = env.spec();
    OIIO::ImageSpec spec(all.full_width, all.full_height, 3, OIIO::TypeFloat);
    spec.channelnames = { "R", "G", "B" };
    spec.extra_attribs = all.extra_attribs;
    const auto state = std::make_shared<std::unique_ptr<EnvironmentRows>>();
    const auto next = std::make_shared<int>(0);
    return Environment(
        spec, [env, state, next, cuts = m_cuts, sanitize = m_sanitize](int y, float* rgb, std::string& error) {
            if (!*state || y < *next) { // a new pass
                *state = std::make_unique<EnvironmentRows>(env, sanitize);
                *next = 0;
                if (!(*state)->open()) {
                    error = (*state)->error();
                    return false;
                }
            }
            for (; *next <= y; ++*next)
                if (!(*state)->read(*next, rgb)) {
                    error = (*state)->error();
                    return false;
                }
            cut_row(rgb, (*state)->grid(), y, cuts, [](size_t, int, const V3d&, const std::array<double, 3>&) {});
            return true;
        });
}

} // namespace vmlight
