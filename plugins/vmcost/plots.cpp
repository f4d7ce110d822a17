// SPDX-License-Identifier: Apache-2.0
#include "plots.h"

#include "models.h"

#include <OpenImageIO/strutil.h>

namespace vmlight::cost {
namespace {

using OIIO::Strutil::fmt::format;

constexpr const char* kStyle = "set encoding utf8\n"
                               "set logscale xy\n"
                               "set grid xtics ytics mxtics mytics lc rgb '#d8d8d8', lc rgb '#eeeeee'\n"
                               "set border 3 lc rgb '#444444'\n"
                               "set tics nomirror\n"
                               "set key outside right top Left reverse samplen 2\n"
                               "set ylabel 'relative RMS error, %'\n"
                               "set format y '%g'\n";

// Collects what is drawn, with its data before it.
class Script
{
public:
    void draw(const std::vector<Point>& points, double (*x)(const Point&), const std::string& style)
    {
        const std::string name = format("$d{}", m_count++);
        m_data += name + " << EOD\n";
        for (const Point& point : points)
            if (x(point) > 0)
                m_data += format("{:.6g} {:.6g}\n", x(point), 100 * point.rmse);
        m_data += "EOD\n";
        m_plot += (m_plot.empty() ? "plot " : ", ") + name + " using 1:2 " + style;
    }
    std::string text(const std::string& settings) const { return kStyle + settings + m_data + m_plot + "\n"; }

private:
    int m_count = 0;
    std::string m_data, m_plot;
};

std::vector<std::string> drawn_models()
{
    std::vector<std::string> names;
    for (const Model& model : models())
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
    script.draw(pareto_front(points), seconds_of, "with steps lw 5 lc rgb '#40009e73' title 'least for its time'");
    return { "error_time",
             "Error against the time of a first picture: bake, filter, shade. Each curve is a model "
             "from few rays to many; the broad line is the least error for its time.",
             script.text("set xlabel 'seconds to a first picture'\nset format x '%g'\n") };
}

Plot bytes_plot(const std::vector<Point>& points)
{
    Script script;
    for (const Model& model : models()) {
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
             "Error at the default settings against the bytes that are read of a texel, stored as float "
             "and as half.",
             script.text(
                 "set xlabel 'bytes a texel'\nset format x '%g'\nset logscale x 2\nset offsets graph 0.1, graph "
                 "0.1, graph 0.1, graph 0.1\n") };
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
             "Error against rays a texel. The ring is the count beyond which a model gains next to "
             "nothing: what is left is the model's own.",
             script.text("set xlabel 'rays a texel'\nset format x '%g'\nset logscale x 2\n") };
}

} // namespace

std::vector<Plot> plots(const std::vector<Point>& points)
{
    return { time_plot(points), bytes_plot(points), rays_plot(points) };
}

std::string svg_script(const Plot& plot)
{
    // A name keeps the marks of one plot from those of another in the same page.
    return format("set terminal svg size 760,430 dynamic font 'sans-serif,14' name '{}' background 'white'\n",
                  plot.name)
        + plot.script;
}

std::string png_script(const Plot& plot)
{
    return "set terminal pngcairo size 1140,645 font 'sans,16' background 'white'\n" + plot.script;
}

} // namespace vmlight::cost
