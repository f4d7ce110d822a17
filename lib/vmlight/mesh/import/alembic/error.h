// SPDX-License-Identifier: Apache-2.0
/// What every part of the Alembic reader uses.
#pragma once

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>

#include <OpenImageIO/strutil.h>

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace vmlight::alembic {

/// Why a file cannot be read, without its path. Caught by without_errors().
struct Error : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

/// Do `work`. False, with the reason in `error`, if it or the library throws.
template <class Work> bool without_errors(std::string& error, const Work& work)
{
    try {
        work();
        return true;
    } catch (const Error& reason) {
        error = shortened_line(reason.what());
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& exception) { // the library throws at whatever it cannot read
        error = format("damaged or cut short, says the Alembic library: {}",
                       shortened_line(OIIO::Strutil::strip(exception.what())));
    }
    return false;
}

} // namespace vmlight::alembic
