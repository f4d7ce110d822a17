// SPDX-License-Identifier: Apache-2.0
#include "film.h"

#include <vmlight/base/format.h>
#include <vmlight/base/output_file.h>

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include <sys/wait.h>
#include <unistd.h>

namespace vmlight::frames {
namespace {

struct Film
{
    const char *extension, *options;
};
constexpr std::array<Film, 3> kFilms { { { "mp4", "-c:v libx264 -pix_fmt yuv420p -crf 18 -movflags +faststart -f mp4" },
                                         { "mov", "-c:v libx264 -pix_fmt yuv420p -crf 18 -f mov" },
                                         { "webm", "-c:v libvpx-vp9 -pix_fmt yuv420p -crf 24 -b:v 0 -f webm" } } };

const Film* film_of(const std::string& path)
{
    const std::string extension = OIIO::Strutil::lower(OIIO::Filesystem::extension(path, false));
    const auto found
        = std::find_if(kFilms.begin(), kFilms.end(), [&](const Film& film) { return extension == film.extension; });
    return found == kFilms.end() ? nullptr : &*found;
}

// 8 bit R, G, B of an even number of columns and rows.
std::vector<uint8_t> raw_pixels(const OIIO::ImageBuf& picture, int width, int height)
{
    const bool has_alpha = picture.spec().alpha_channel == 3;
    std::vector<uint8_t> bytes;
    bytes.reserve(size_t(width) * size_t(height) * 3);
    const OIIO::ImageBuf image = picture.copy(OIIO::TypeFloat);
    for (OIIO::ImageBuf::ConstIterator<float> pixel(image, OIIO::ROI(0, width, 0, height)); !pixel.done(); ++pixel)
        for (int c = 0; c < 3; ++c) {
            const float value = pixel[c] * (has_alpha ? float(pixel[3]) : 1.0f);
            bytes.push_back(uint8_t(std::lround(std::clamp(value, 0.0f, 1.0f) * 255)));
        }
    return bytes;
}

} // namespace

bool is_film_name(const std::string& path)
{
    return film_of(path) != nullptr;
}

std::string film_fault()
{
    return std::system("ffmpeg -version >/dev/null 2>&1") == 0
        ? ""
        : "films need ffmpeg, which is not installed: install the package ffmpeg, or write a .gif or frames";
}

bool write_film(const std::vector<OIIO::ImageBuf>& pictures, const std::string& path, double fps, std::string& error)
{
    const int width = pictures[0].spec().width / 2 * 2, height = pictures[0].spec().height / 2 * 2;
    error
        = width < 2 || height < 2 ? format("\"{}\": a film needs at least 2x2 pixels", path) : output_file_fault(path);
    if (!error.empty())
        return false;
    OutputFile file(path, TemporaryFileKind::Hidden);
    if (!file.ok()) {
        error = format("\"{}\": {}", path, file.reason());
        return false;
    }
    // The path goes by the environment, where nothing in it has a meaning for the shell; what is "self" here is another
    // process there.
    const std::string own = format("/proc/{}/", ::getpid());
    const std::string target = "file:" + OIIO::Strutil::replace(file.temporary_path(), "/proc/self/", own);
    ::setenv("VMLIGHT_FILM", target.c_str(), 1);
    const std::string command
        = format("exec ffmpeg -nostdin -loglevel error -y -f rawvideo -pix_fmt rgb24 -s {}x{} -r {} -i pipe:0 {} "
                 "\"$VMLIGHT_FILM\"",
                 width, height, fps, film_of(path)->options);
    std::FILE* pipe = ::popen(command.c_str(), "w");
    bool good = pipe != nullptr;
    for (const OIIO::ImageBuf& picture : pictures) {
        const std::vector<uint8_t> bytes = raw_pixels(picture, width, height);
        good = good && std::fwrite(bytes.data(), 1, bytes.size(), pipe) == bytes.size();
    }
    const int code = pipe ? ::pclose(pipe) : -1;
    ::unsetenv("VMLIGHT_FILM");
    if (good && code == 0 && file.commit())
        return true;
    error = good && code == 0
        ? format("\"{}\": {}", path, file.reason())
        : format("\"{}\": ffmpeg failed with exit code {}", path, WIFEXITED(code) ? WEXITSTATUS(code) : code);
    return false;
}

} // namespace vmlight::frames
