// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/gltf/error.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <OpenImageIO/strutil.h>

#include <exception>
#include <new>

namespace vmlight::gltf {

bool without_errors(std::string& error, const std::function<void()>& read)
{
    try {
        read();
        return true;
    } catch (const Error& reason) {
        error = shortened_line(OIIO::Strutil::strip(reason.what()));
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) { // of the libraries that the room uses
        error = format("cannot read as glTF 2.0: {}", shortened_line(exception.what()));
    }
    return false;
}

} // namespace vmlight::gltf
