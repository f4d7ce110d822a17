// SPDX-License-Identifier: Apache-2.0
/// The URIs of glTF files. Source: RFC 3986 (URIs), RFC 2397 (data URIs).
#pragma once

#include <string>

namespace vmlight::gltf {

/// Each %XX as the byte it stands for; a % without two hexadecimal digits stays.
std::string decode_percent(const std::string& text);

/// "http" of "http://a/b", "" of a path (also of "C:\a": a scheme has two letters or more).
std::string uri_scheme(const std::string& uri);

/// The bytes of a "data:" URI, in base64 or percent-encoded. Base64 ends where it is invalid. False if there are none,
/// or more than 2 GiB.
bool decode_data_uri(std::string& bytes, const std::string& uri);

} // namespace vmlight::gltf
