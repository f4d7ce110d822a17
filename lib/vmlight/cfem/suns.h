// SPDX-License-Identifier: Apache-2.0
/// Suns: lights so small and strong that their shadows have edges, and the wide lights beside them. An environment is
/// split into these, as uniform discs whose visibility can be traced, and a smooth rest, which shading models are good
/// at.
#pragma once

#include <vmlight/base/progress.h>
#include <vmlight/cfem/environment.h>
#include <vmlight/math/disc.h>

#include <OpenImageIO/imageio.h>

#include <array>
#include <memory>
#include <string>
#include <vector>

namespace vmlight {

/// `vmlight:suns` of a filtered environment whose suns were split off: suns_text() of them, or kUnknownSuns if they
/// were not known yet when the metadata was made. Not there if there are none.
constexpr const char* kSunsAttribute = "vmlight:suns";
constexpr const char* kUnknownSuns = "auto";

/// A uniform disc of light, in the frame of the environment.
struct Sun
{
    Disc disc;
    /// Irradiance / pi on a surface that faces it, R, G, B: what it adds to a CFEM in its own direction, but for the
    /// factor disc_mean_length().
    std::array<double, 3> color {};
};

/// Whether it is a part of a wide light, and no sun: a half angle above 5 degrees.
bool is_wide(const Sun& sun);

/// "x y z half_angle_in_degrees r g b; ..."
std::string suns_text(const std::vector<Sun>& suns);
/// The suns that suns_text() wrote. Returns false, with the reason in `error`, if the text is something else.
bool parse_suns(std::vector<Sun>& dst, const std::string& text, std::string& error);

/// An environment without its suns. Copies share what they hold.
class SunSplit
{
public:
    /// Find the suns of `env`. There is nothing to choose: a light is split off if it is narrow (a disc's half angle
    /// of 10 degrees counts nothing, of 5 degrees half) and carries, so weighted, at least a thirty-second of all
    /// light: less than the models' own error on what remains. Where there is one, as in a room with lamps, further
    /// lights are too, down to a 128th of all light and a sixteenth of what was split off before: beside a strong sun a
    /// weaker light's shadows hardly count. The strongest comes first. Each is cut out
    /// by a cap of 1.5 to 12 degrees: what is brighter than the median around the cap, channel by channel, is the
    /// sun's.
    ///
    /// Where there is a sun, wide lights of what remains are split off as well, such as its glow or a window: cut out
    /// by caps of 12 to 30 degrees, likewise, if they carry at least a thirty-second of all light and a sixteenth of
    /// what was split off before; here, a disc of 60 degrees counts nothing. A wide light is parted at its middle,
    /// above and below, left and right, in up to Cut::kParts discs, which follow the suns.
    ///
    /// At most kMostSuns lights in all. A disc has the energy and the first moment (by the mean of R, G and B) of what
    /// was cut out for it.
    ///
    /// @param env      read twice; must outlive this and rest(), as for make_cfem()
    /// @param sanitize repair bad pixels instead of refusing the image
    /// @returns false, with the reason in `error`, if make_cfem() would refuse `env` or `progress` stopped it
    /// The cuts depend on the map's pixels by way of their means over 512x256 only, so that larger sizes and rotations
    /// of one environment give one result: directions within .1 degrees, light within 1 %.
    bool find(const Environment& env, bool sanitize, std::string& error, const Progress& progress = {});

    static constexpr size_t kMostSuns = 8; ///< a wide light counts once

    const std::vector<Sun>& suns() const { return m_suns; }
    /// The suns' share of all light, 0 to 1.
    double share() const { return m_share; }
    /// NaN, infinite and negative values that were repaired.
    int64_t bad_values() const { return m_bad_values; }

    /// The environment without the suns: `env` itself if there are none, else R, G, B of its display window, repaired,
    /// and never above `env`.
    Environment rest(const Environment& env) const;

    /// Where a sun is cut out: a cap with a soft edge, so that what is cut out of a map hardly depends on its size.
    struct Cut
    {
        Imath::V3d centre { 0, 1, 0 };
        double radius = 0; ///< radians
        std::array<float, 3> background {};
        /// Where a wide light is parted in four, above and below, left and right; zero for a sun, which is one disc.
        Imath::V3d middle { 0 };

        static constexpr int kParts = 4;
        /// The part that a direction belongs to, 0 to kParts - 1.
        int part_of(const Imath::V3d& direction) const;

        /// How much of a pixel, `height` radians high, whose middle is at `angle` radians from the centre is the cap's.
        double share_at(double angle, double height) const;
        /// Take its light above the background from a pixel of R, G, B whose middle is in `direction`. Returns what was
        /// taken.
        std::array<double, 3> apply(float* rgb, const Imath::V3d& direction, double height) const;
    };

private:
    bool measure(const Environment& env, std::vector<Cut>& cuts, std::string& error, const Progress& progress);

    bool m_sanitize = false;
    int64_t m_bad_values = 0;
    double m_share = 0;
    std::vector<Sun> m_suns;
    std::vector<Cut> m_cuts; // in the order in which they are applied
};

} // namespace vmlight
