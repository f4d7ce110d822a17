#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7 (Debian 12's libopenimageio2.4 2.4.7.1+dfsg-2), glibc 2.36.
#
# The shared ImageCache, which TextureSystem, oiiotool and Python use, lives until OpenImageIO's own globals are destroyed.
# Images that it still has open are deleted then, by the destructor of the plugin's ImageInput. A plugin is linked with
# OpenImageIO, so by then the loader has destroyed the globals of the plugin, and of libraries that only the plugin needs.
# Whatever the destructor uses of them is gone: here, a plain global of the plugin. A plugin whose inputs hold handles of a
# library that locks a global mutex to release them ends its host with an error after all work is done, and only if enough
# images are open. Programs that call ImageCache::destroy() with teardown before they end are safe.
#
# Needs g++, the libraries that Debian 12's libopenimageio-dev depends on, and apt-get with the archive of Debian 12 on
# amd64; installs nothing: unpacks the packages in a temporary folder. Exits with 1 if the answer is another than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in libopenimageio2.4=2.4.7.1+dfsg-2 libopenimageio-dev=2.4.7.1+dfsg-2; do
    apt-get -qq download -o APT::Sandbox::User=root "$package"
done
for package in ./*.deb; do dpkg-deb -x "$package" root; done
libraries=$folder/root/usr/lib/x86_64-linux-gnu

# A reader of files .gray: one tile of 16x16 texels of one value.
cat >gray.cpp <<'END'
#include <OpenImageIO/imageio.h>
#include <algorithm>
#include <cstdio>
using namespace OIIO;
static struct Library
{
    const char* state = "ready";
    ~Library()
    {
        state = "destroyed";
        std::puts("the plugin's globals are destroyed");
    }
} library;
class GrayInput : public ImageInput
{
public:
    ~GrayInput() override
    {
        const char* const volatile* state = &library.state; // read it even if the compiler thinks that it knows
        std::printf("an image is closed: globals %s\n", *state);
    }
    const char* format_name() const override { return "gray"; }
    bool open(const std::string&, ImageSpec& spec) override
    {
        m_spec = ImageSpec(16, 16, 1, TypeDesc::FLOAT);
        m_spec.tile_width = m_spec.tile_height = 16;
        spec = m_spec;
        return true;
    }
    bool read_native_scanline(int, int, int, int, void*) override { return false; }
    bool read_native_tile(int, int, int, int, int, void* data) override
    {
        std::fill_n(static_cast<float*>(data), 16 * 16, 0.5f);
        return true;
    }
    int supports(string_view feature) const override { return feature == "tiles"; }
    bool close() override { return true; }
};
extern "C" {
OIIO_EXPORT int gray_imageio_version = OIIO_PLUGIN_VERSION;
OIIO_EXPORT const char* gray_imageio_library_version() { return nullptr; }
OIIO_EXPORT ImageInput* gray_input_imageio_create() { return new GrayInput; }
OIIO_EXPORT const char* gray_input_extensions[] = { "gray", nullptr };
}
END
cat >host.cpp <<'END'
#include <OpenImageIO/imagecache.h>
#include <cstdio>
#include <cstring>
using namespace OIIO;
int main(int argc, char**)
{
    ImageCache* cache = ImageCache::create(true);
    float texel = 0;
    cache->get_pixels(ustring("card.gray"), 0, 0, 3, 4, 3, 4, 0, 1, TypeDesc::FLOAT, &texel);
    std::printf("a texel is %g\n", texel);
    if (argc > 1)
        ImageCache::destroy(cache, true);
    std::puts("the program ends");
}
END
flags=(-std=c++17 -I root/usr/include -I /usr/include/Imath -L "$libraries")
g++ "${flags[@]}" -shared -fPIC gray.cpp -lOpenImageIO -lOpenImageIO_Util -o gray.imageio.so
g++ "${flags[@]}" host.cpp -lOpenImageIO -lOpenImageIO_Util -o host
touch card.gray
{
    for teardown in '' teardown; do
        echo "${teardown:-without}:"
        # shellcheck disable=SC2086
        LD_LIBRARY_PATH=$libraries OIIO_LIBRARY_PATH=$folder ./host $teardown | sed 's/^/  /'
    done
} | tee seen

# The first is closed once OpenImageIO knows what reads the file.
diff - seen <<'END'
without:
  an image is closed: globals ready
  a texel is 0.5
  the program ends
  the plugin's globals are destroyed
  an image is closed: globals destroyed
teardown:
  an image is closed: globals ready
  a texel is 0.5
  an image is closed: globals ready
  the program ends
  the plugin's globals are destroyed
END
