// SPDX-License-Identifier: Apache-2.0
/// Which sanitizer this is built with, in GCC's words, which clang 14 does not know: __SANITIZE_ADDRESS__ and
/// __SANITIZE_THREAD__.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer) && !defined(__SANITIZE_THREAD__)
#define __SANITIZE_THREAD__ 1
#endif
#endif
