#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Draco 1.5.5 and tinygltf 2.7.0 (Debian 12's libdraco7 1.5.5+dfsg-2 and libtinygltf2d 2.7.0+dfsg-2).
#
# libdraco.so.7 exports the functions of the older tinygltf that it was built with, under the names that libtinygltf.so
# has too. The classes of the two differ in layout, and some signatures do (Model* against const Model*). A program that
# uses both libraries, as a reader of glTF does, gets the functions of whichever was linked first. With Draco first the
# parser of the old tinygltf fills in the new one's Model: ours died when it freed that, at some runs only. libassimp
# brings libdraco along, so that a host application may have it loaded before any plug-in.
#
# This asks the loader whose function a program got; it does not call it.
# Needs g++, and apt-get with the archive of Debian 12 on amd64; installs nothing: unpacks the packages in a temporary
# folder. Exits with 1 if the answer is another than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in libdraco7=1.5.5+dfsg-2 libdraco-dev=1.5.5+dfsg-2 libtinygltf2d=2.7.0+dfsg-2 libtinygltf-dev=2.7.0+dfsg-2; do
    apt-get -qq download -o APT::Sandbox::User=root "$package"
done
for package in ./*.deb; do dpkg-deb -x "$package" root; done
libraries=$folder/root/usr/lib/x86_64-linux-gnu

cat >whose.cpp <<'END'
#include <tiny_gltf.h>
#include <dlfcn.h>
#include <cstdio>
#include <cstring>
int main()
{
    auto load = &tinygltf::TinyGLTF::LoadASCIIFromString;
    void* address;
    std::memcpy(&address, &load, sizeof(address));
    Dl_info info;
    if (dladdr(address, &info))
        std::puts(std::strrchr(info.dli_fname, '/') + 1);
}
END
whose() {
    g++ -std=c++17 -fPIC whose.cpp -I root/usr/include -L "$libraries" -Wl,--no-as-needed "$@" -o whose
    LD_LIBRARY_PATH=$libraries ./whose
}

{
    for library in libdraco.so.7 libtinygltf.so.2d; do
        echo "$library: $(nm -D --defined-only -C "$libraries/$library" | grep -o 'TinyGLTF::WriteGltfSceneToStream([^,]*')"
    done
    echo "linked as -ltinygltf -ldraco: $(whose -ltinygltf -ldraco)"
    echo "linked as -ldraco -ltinygltf: $(whose -ldraco -ltinygltf)"
} | tee seen

diff - seen <<'END'
libdraco.so.7: TinyGLTF::WriteGltfSceneToStream(tinygltf::Model*
libtinygltf.so.2d: TinyGLTF::WriteGltfSceneToStream(tinygltf::Model const*
linked as -ltinygltf -ldraco: libtinygltf.so.2d
linked as -ldraco -ltinygltf: libdraco.so.7
END
