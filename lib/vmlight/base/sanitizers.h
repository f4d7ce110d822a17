// SPDX-License-Identifier: Apache-2.0
/// Defines GCC's sanitizer macros, __SANITIZE_ADDRESS__ and __SANITIZE_THREAD__, for clang 14 too.
#pragma once

#if defined(__has_feature)
#if __has_feature(address_sanitizer) && !defined(__SANITIZE_ADDRESS__)
#define __SANITIZE_ADDRESS__ 1
#endif
#if __has_feature(thread_sanitizer) && !defined(__SANITIZE_THREAD__)
#define __SANITIZE_THREAD__ 1
#endif
#endif
