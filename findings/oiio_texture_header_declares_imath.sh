#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# OpenImageIO 2.4.7.1 and Imath 3.1.6 (Debian 12's libopenimageio-dev 2.4.7.1+dfsg-2 and libimath-dev 3.1.6-1).
#
# OpenImageIO/texture.h declares Imath::Vec3 and Imath::V3f by itself where no header of Imath came before it. Imath has them
# in an inline namespace of its version, Imath_3_1, so these are other types, and the name Imath::V3f is the incomplete one
# from then on: a file that includes <Imath/ImathVec.h> after texture.h, directly or by a header of its own, cannot use its
# vectors. The other way round compiles. Neither order is an error of the #include itself, and a formatter that sorts
# includes may bring it about, or a precompiled header hide it.
#
# Needs g++, and apt-get with the archive of Debian 12; installs nothing: unpacks the packages in a temporary folder. Exits
# with 1 if the answer is another than written here.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
for package in libopenimageio-dev=2.4.7.1+dfsg-2 libimath-dev=3.1.6-1; do
    apt-get -qq download -o APT::Sandbox::User=root "$package"
done
for package in ./*.deb; do dpkg-deb -x "$package" root; done

# compiles HEADER...: whether a file that includes these, in this order, can use Imath's vector.
compiles() {
    { printf '#include <%s>\n' "$@"; echo 'Imath::V3f up(0, 1, 0);'; } >order.cpp
    if g++ -std=c++17 -fsyntax-only -I root/usr/include -I root/usr/include/Imath order.cpp 2>errors; then
        echo "compiles: $*"
    else
        echo "does not compile: $*: $(grep -o 'incomplete type' errors | head -n 1)"
    fi
}

{
    compiles Imath/ImathVec.h OpenImageIO/texture.h
    compiles OpenImageIO/texture.h Imath/ImathVec.h
} | tee seen

diff - seen <<'END'
compiles: Imath/ImathVec.h OpenImageIO/texture.h
does not compile: OpenImageIO/texture.h Imath/ImathVec.h: incomplete type
END
