// SPDX-License-Identifier: Apache-2.0
/// What texts about parameters are made of. value_text() and allowed_text(), which params.h declares, lie with them.
#pragma once

#include <vmlight/base/params.h>

#include <string>
#include <vector>

namespace vmlight {

/// The shorter of 6 and 17 digits that reads back to the same value.
std::string number_text(double value);
/// As errors say it: "[0, 1]", with the word that stands for a number if there is one.
std::string range_text(const Range& range);
/// The words of choices, without their meanings.
std::vector<std::string> words_of(const std::vector<Choice>& choices);
/// `words` in the order of `allowed`, in which every one of them occurs.
std::vector<std::string> in_order(std::vector<std::string> words, const ChoiceSet& allowed);

} // namespace vmlight
