// SPDX-License-Identifier: Apache-2.0
#pragma once

/// Marks what the library shows; all else is hidden, so that a plugin that links it shows only its own symbols.
#define VMLIGHT_API __attribute__((visibility("default")))
