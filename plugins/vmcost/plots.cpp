// SPDX-License-Identifier: Apache-2.0
#include "plots.h"

#include "models.h"

#include <vmlight/base/format.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <limits>

namespace vmlight::cost {
namespace {

constexpr const char* kStyle = "set encoding utf8\n"
                               "set logscale xy\n"
                               "set grid xtics ytics lt 1 lw 1 lc rgb '#dddddd'\n"
                               "set border 3 lc rgb '#444444'\n"
                               "set tics nomirror\n"
                               "set key outside right top Left reverse samplen 2\n"
                               "set ylabel 'relative RMS error, %'\n"
                               "set format '%g'\n";

struct Bounds
{
    double low = std::numeric_limits<double>::max(), high = 0;
    void add(double value)
    {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    // With a little margin; gnuplot would round a logarithmic axis to whole decades.
    std::string text(double margin) const { return format("[{:.6g}:{:.6g}]", low / margin, high * margin); }
};

// Axis labels: the fewer decades, the more labels per decade.
std::string log_tics(const Bounds& bounds)
{
    const double span = bounds.high / bounds.low;
    const std::vector<double> steps = span > 20 ? std::vector<double> { 1, 2, 5 }
        : span > 4                              ? std::vector<double> { 1, 1.5, 2, 3, 5, 7 }
                   : std::vector<double> { 1, 1.2, 1.4, 1.6, 1.8, 2, 2.5, 3, 3.5, 4, 5, 6, 7, 8, 9 };
    std::vector<std::string> tics;
    for (double decade = 1e-5; decade < 1e4; decade *= 10)
        for (const double step : steps)
            tics.push_back(format("{:g}", decade * step));
    return OIIO::Strutil::join(tics, ",");
}

// Collects data blocks and the plot command.
class Script
{
public:
    void draw(const std::vector<Point>& points, double (*x)(const Point&), const std::string& style)
    {
        std::string data;
        for (const Point& point : points)
            if (x(point) > 0 && point.rmse > 0) { // the axes are logarithmic
                data += format("{:.6g} {:.6g}\n", x(point), 100 * point.rmse);
                m_x.add(x(point));
                m_y.add(100 * point.rmse);
            }
        if (data.empty())
            return;
        const std::string name = format("$d{}", m_count++);
        m_data += name + " << EOD\n" + data + "EOD\n";
        m_plot += (m_plot.empty() ? "plot " : ", ") + name + " using 1:2 " + style;
    }
    std::string text(const std::string& settings, bool decimal_x = false) const
    {
        if (!m_count)
            return kStyle + settings + "plot [1:100] [1:100] NaN notitle\n";
        return kStyle + settings + (decimal_x ? format("set xtics ({})\n", log_tics(m_x)) : "")
            + format("set ytics ({})\nset xrange {}\nset yrange {}\n", log_tics(m_y), m_x.text(1.15), m_y.text(1.1))
            + m_data + m_plot + "\n";
    }

private:
    int m_count = 0;
    Bounds m_x, m_y;
    std::string m_data, m_plot;
};

std::vector<std::string> drawn_models()
{
    std::vector<std::string> names;
    for (const ModelVariant& model : model_variants())
        names.push_back(model.name);
    names.push_back(kTraced);
    return names;
}

std::string line_style(const std::string& model)
{
    return format("with linespoints lw 2 pt 7 ps 0.5 lc rgb '{}'{} title '{}'", color_of(model),
                  model == kTraced ? " dt 2" : "", model);
}

double seconds_of(const Point& point)
{
    return point.total();
}
double bytes_of(const Point& point)
{
    return point.bytes;
}
double rays_of(const Point& point)
{
    return point.setting.samples;
}

Plot time_plot(const std::vector<Point>& points)
{
    Script script;
    for (const std::string& model : drawn_models())
        script.draw(curve(points, model), seconds_of, line_style(model));
    script.draw(points, seconds_of, "with points pt 7 ps 0.3 lc rgb '#999999' title 'other settings'");
    script.draw(pareto_front(points), seconds_of, "with steps lw 4 lc rgb '#80009e73' title 'best at its time'");
    return { "error_time",
             "Error against the time to a first picture: bake, filter, shade. Each curve is a model, "
             "from few rays to many; the thick line is the lowest error at each time.",
             script.text("set xlabel 'seconds to a first picture'\n", true) };
}

Plot bytes_plot(const std::vector<Point>& points)
{
    Script script;
    for (const ModelVariant& model : model_variants()) {
        std::vector<Point> found;
        for (const Point& point : points) {
            Setting plain = point.setting;
            plain.storage = "float";
            if (plain == default_setting(model.name))
                found.push_back(point);
        }
        script.draw(found, bytes_of, line_style(model.name));
    }
    return { "error_bytes",
             "Error at the default settings against the bytes read per texel, stored as float and as "
             "half.",
             script.text("set xlabel 'bytes per texel'\nset logscale x 2\n") };
}

Plot rays_plot(const std::vector<Point>& points)
{
    Script script;
    std::vector<Point> knees;
    for (const std::string& model : drawn_models()) {
        const std::vector<Point> line = curve(points, model);
        script.draw(line, rays_of, line_style(model));
        if (!line.empty() && model != kTraced)
            knees.push_back(knee(line));
    }
    script.draw(knees, rays_of,
                format("with points pt 6 ps 1.8 lw 2 lc rgb '#222222' title 'gains < {:g} % beyond'", 100 * kKneeGain));
    return { "error_rays",
             "Error against rays per texel. Beyond the ring a model gains almost nothing from more rays: "
             "the remaining error is the model's own.",
             script.text("set xlabel 'rays per texel'\nset logscale x 2\n") };
}

} // namespace

std::vector<Plot> plots(const std::vector<Point>& points)
{
    return { time_plot(points), bytes_plot(points), rays_plot(points) };
}

std::string svg_script(const Plot& plot)
{
    // The name keeps element ids unique if a page has several plots.
    return format("set terminal svg size 760,430 dynamic font 'sans-serif,14' name '{}' background 'white'\n",
                  plot.name)
        + plot.script;
}

std::string png_script(const Plot& plot)
{
    return "set terminal pngcairo size 1140,645 font 'sans,16' background 'white'\n" + plot.script;
}

} // namespace vmlight::cost
