// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks exported symbols. All others are hidden, so that a plugin that links the library exports only its own.
#define VMLIGHT_API __attribute__((visibility("default")))
