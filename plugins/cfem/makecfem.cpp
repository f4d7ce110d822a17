// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cfem.h>
#include <vmlight/color.h>
#include <vmlight/image_file.h>
#include <vmlight/stage_main.h>

#include <OpenImageIO/strutil.h>
#include <OpenImageIO/timer.h>

using namespace vmlight;
using OIIO::Strutil::fmt::format;

int main(int argc, const char** argv)
{
    CfemParams params;
    ColorSettings color;
    StageMain stage("makecfem", "filter an environment with a cosine: the diffuse light for each direction",
                    { "ENVIRONMENT" },
                    "  makecfem studio.exr -o studio_cfem.exr\n"
                    "  makecfem sky.hdr --colorconfig config.ocio --resolution 512 -o sky_cfem.exr");
    stage.params("Filter:", params);
    stage.group("Colour:");
    stage.option("colorspace", "NAME", "Colour space of the environment, if its name and tags do not tell", color.from);
    stage.option("colorconfig", "FILE", "OCIO config; without it $OCIO", color.config);

    return stage.run(argc, argv, [&](std::string& error) {
        error = output_fault(stage.output());
        OIIO::ImageBuf environment, cfem;
        std::string note;
        if (!error.empty() || !read_image(environment, stage.operand(0), error)
            || !to_scene_linear(environment, stage.operand(0), color, note, error))
            return false;
        const OIIO::Timer timer;
        if (!make_cfem(cfem, environment, params, stage.threads(), stage.progress("filter"))) {
            error = format("\"{}\": {}", stage.operand(0), cfem.geterror());
            return false;
        }
        const double seconds = timer();
        if (!stage.write(cfem, error))
            return false;
        stage.say("colour: " + note);
        stage.say(format("filter: {}x{} to {}x{} in {:.3f} s", environment.spec().width, environment.spec().height,
                         cfem.spec().width, cfem.spec().height, seconds));
        if (const int mended = cfem.spec().get_int_attribute("vmlight:sanitized"))
            stage.warn(format("{} bad values of the environment were mended", mended));
        return true;
    });
}
