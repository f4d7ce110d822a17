// SPDX-License-Identifier: Apache-2.0
/// make_lightmap() and Relighter.
#include "function.h"
#include "image.h"
#include "light_input.h"
#include "stages.h"
#include "work.h"

#include <algorithm>
#include <array>
#include <memory>
#include <mutex>

namespace vmlight::python {
namespace {

const char* const kLightmap
    = "Light a visibility map with an environment: the texture to render with.\n\n"
      "Files are lit as makelightmap lights them, to the same bytes. Suns and bounced light are traced on files alone. "
      "To\nlight a map many times, use Relighter.";
const char* const kLightmapReturns = "R, G, B as float32, in the units of the light";
const char* const kRelighter
    = "A visibility map and its light, read and filtered once, to be lit for many rotations.\n\n"
      "Safe to share between threads, which take turns. Results that nobody holds any more give their memory to the "
      "next "
      "one.";

/// What may change from one lightmap to the next.
struct RelightArguments
{
    LightmapParams params;

    template <class Visit> void visit(Visit&& field)
    {
        params.visit([&](const char* name, auto& value, const auto& allowed, const Help& help) {
            if (std::string(name) != "model")
                field(name, value, allowed, help);
        });
    }
};

class Relighter
{
public:
    Relighter(const Call& call, const LightmapArguments& given)
        : m_input(call, given, true)
    {
        do_work(call.work, m_input.paths(),
                [&](const MakeOptions& options, std::string& error) { return m_input.read(options, error); });
    }

    Image light(const Call& call)
    {
        const LightmapParams params = params_of(call);
        check_rotation(params);
        // No other thread of Python runs before this one holds the image too.
        SharedImage dst;
        for (SharedImage& kept : m_kept)
            if (!dst && (!kept || kept.use_count() == 1))
                dst = std::move(kept);
        if (!dst)
            dst = std::make_shared<OIIO::ImageBuf>();
        do_work(call.work, {}, [&](const MakeOptions& options, std::string& error) {
            const std::lock_guard<std::mutex> lock(m_mutex);
            return m_input.light(*dst, params, options, error);
        });
        const auto empty = std::find(m_kept.begin(), m_kept.end(), nullptr);
        if (empty != m_kept.end())
            *empty = dst;
        return { { dst } };
    }

private:
    // Those of the call; others as they were given when this was made. A rotation of the object replaces another.
    LightmapParams params_of(const Call& call) const
    {
        RelightArguments given { m_input.params() };
        LightmapParams& params = given.params;
        if (call.has("rotate") || call.has("matrix") || call.has("quaternion"))
            params.rotate = params.matrix = params.quaternion = {};
        set_params(given, call.keywords);
        return params;
    }

    LightInput m_input;
    std::mutex m_mutex;
    // While a caller looks at one, the next is made.
    std::array<SharedImage, 2> m_kept;
};

} // namespace

void define_lightmaps(py::module_& m)
{
    const Signature<LightmapArguments> lightmap(
        { "make_lightmap", FunctionKind::function, kLightmap, lightmap_operands(), "Image", kLightmapReturns },
        lightmap_operand_params());
    m.def(
        "make_lightmap",
        [lightmap](const py::args& args, const py::kwargs& kwargs) {
            const auto [call, given] = lightmap.read(args, kwargs);
            LightInput input(call, given, false);
            OIIO::ImageBuf dst;
            do_work(call.work, input.paths(), [&](const MakeOptions& options, std::string& error) {
                return input.read(options, error) && input.light(dst, input.params(), options, error);
            });
            return own_one(std::move(dst));
        },
        docstring(lightmap.function()).c_str());
    add_to_table("make_lightmap", lightmap.function());

    const Signature<LightmapArguments> making(
        { "Relighter", FunctionKind::constructor, kRelighter, lightmap_operands(), "", "" }, lightmap_operand_params());
    const Signature<RelightArguments> relighting({ "light",
                                                   FunctionKind::method,
                                                   "Light the map. What is not given is as it was given to Relighter; "
                                                   "rotate, matrix and quaternion replace each "
                                                   "other.",
                                                   {},
                                                   "Image",
                                                   kLightmapReturns });
    py::class_<Relighter, std::shared_ptr<Relighter>> relighter(m, "Relighter", kRelighter);
    relighter.attr("__module__") = "vmlight";
    relighter
        .def(py::init([making](const py::args& args, const py::kwargs& kwargs) {
                 const auto [call, given] = making.read(args, kwargs);
                 return std::make_shared<Relighter>(call, given);
             }),
             docstring(making.function()).c_str())
        .def(
            "light",
            [relighting](Relighter& self, const py::args& args, const py::kwargs& kwargs) {
                return self.light(relighting.read(args, kwargs).first);
            },
            docstring(relighting.function()).c_str());
    add_to_table("Relighter.__init__", making.function());
    add_to_table("Relighter.light", relighting.function());
}

} // namespace vmlight::python
