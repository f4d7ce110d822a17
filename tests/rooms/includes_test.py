# SPDX-License-Identifier: Apache-2.0
"""Files of the library include what they use, so that they compile without the precompiled headers and outside a unity
build, which would hide one that is missing: each name of the tables below, and each function that a header of vmlight
declares at namespace scope, needs its header, in the file or in a header of vmlight that it includes, however far.

Run as: includes_test.py"""
import collections
import functools
import os
import re
import unittest

SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "../..")
ROOTS = [os.path.join(SOURCE, "lib"), os.path.join(SOURCE, "plugins")]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)

# What each precompiled header brings, and what else a missing one of it would let through.
STANDARD = {
    "algorithm": "all_of any_of binary_search clamp copy copy_n count_if equal equal_range fill fill_n find find_if "
                 "generate is_sorted lower_bound max max_element min min_element minmax minmax_element none_of "
                 "nth_element partition remove_if replace reverse sort stable_sort swap_ranges transform unique "
                 "upper_bound",
    "array": "array",
    "atomic": "atomic atomic_flag",
    "chrono": "chrono",
    "cmath": "acos asin atan atan2 ceil cos exp floor fmod hypot isfinite isnan lround pow round sin sqrt tan trunc",
    "condition_variable": "condition_variable",
    "cstdio": "FILE fclose fflush fopen fprintf fputs fread fwrite printf snprintf sscanf",
    "cstdlib": "_Exit abort exit getenv strtol",
    "cstring": "memcmp memcpy memset strcmp strerror strlen",
    "deque": "deque",
    "filesystem": "filesystem",
    "functional": "function hash reference_wrapper",
    "iterator": "back_inserter",
    "limits": "numeric_limits",
    "list": "list",
    "map": "map multimap",
    "memory": "enable_shared_from_this make_shared make_unique shared_ptr unique_ptr weak_ptr",
    "mutex": "call_once lock_guard mutex once_flag scoped_lock unique_lock",
    "numeric": "accumulate iota",
    "optional": "nullopt optional",
    "random": "mt19937 normal_distribution uniform_real_distribution",
    "set": "multiset set",
    "shared_mutex": "shared_lock shared_mutex",
    "sstream": "istringstream ostringstream stringstream",
    "string": "getline stod stoi string to_string",
    "thread": "thread this_thread",
    "tuple": "tie tuple",
    "unordered_map": "unordered_map",
    "unordered_set": "unordered_set",
    "variant": "variant visit",
    "vector": "vector",
}
OIIO = {
    "OpenImageIO/imagebuf.h": r"\bImageBuf\b(?!Algo)",
    "OpenImageIO/imagebufalgo.h": r"\bImageBufAlgo::",
    "OpenImageIO/imageio.h": r"\b(?:ImageInput|ImageOutput|ImageSpec)\b",
    "OpenImageIO/filesystem.h": r"\bFilesystem::",
    "OpenImageIO/strutil.h": r"\bStrutil::",
}
# These are the ways of OIIO's headers to their own interfaces: what a function takes or gives.
BRINGS = {
    "OpenImageIO/imagebufalgo.h": ["OpenImageIO/imagebuf.h", "functional"],
    "OpenImageIO/imagebuf.h": ["OpenImageIO/imageio.h"],
    "OpenImageIO/imageio.h": ["algorithm", "cmath", "limits", "memory", "string", "vector"],
    "OpenImageIO/imagecache.h": ["OpenImageIO/imageio.h"],
    "OpenImageIO/texture.h": ["OpenImageIO/imageio.h"],
    "OpenImageIO/filesystem.h": ["cstdio", "string", "vector"],
    "OpenImageIO/strutil.h": ["algorithm", "map", "string", "vector"],
    "OpenImageIO/ustring.h": ["string"],
    "OpenImageIO/paramlist.h": ["memory", "string", "vector"],
    "OpenImageIO/color.h": ["memory", "string", "vector"],
    "OpenImageIO/thread.h": ["atomic", "functional", "memory", "mutex"],
    "OpenImageIO/parallel.h": ["functional"],
    "toml++/toml.h": ["string", "vector", "memory"],
    "nlohmann/json.hpp": ["string", "vector", "map", "functional", "memory"],
    "unordered_map": ["tuple"],
    "map": ["tuple"],
}
WORDS = {name: header for header, names in STANDARD.items() for name in names.split()}
STANDARD_NAME = re.compile(r"\bstd::(\w+)")

# As clang-format lays them out: what is at namespace scope starts a line, members are indented.
FUNCTION = re.compile(
    r"^(?!(?:using|namespace|class|struct|return|static_assert|typedef|enum)\b)[A-Za-z_][\w:<>,&*\s\[\]]*?[\s&*>]"
    r"([a-z_]\w*)\((?!\*)|^#\s*define\b.*[\s&*>]([a-z_]\w*)\(", re.MULTILINE)
MEMBER = re.compile(r"^[ \t]+(?!(?:return|else|throw|case)\b)(?:[\w:<>,&*\[\]]+[ ]+)+[&*]*([a-z_]\w*)\(", re.MULTILINE)
# Variables, parameters and lambdas: where they are declared, and where they are used as objects.
VARIABLE = re.compile(r"[\w>&*\]][ &*]+([a-z_]\w*)(?= ?[={;,)\[])|(?:\.|->)([a-z_]\w*)\b(?!\()|\b([a-z_]\w*)[.\[]")
USING = re.compile(r"\busing\b[^;=]*;")
CALL = re.compile(r"(?<![\w.>:])(?:(?:\w+::)*(\w+)::)?([a-z_]\w*)\(")


def without_comments(text):
    text = re.sub(r'"(?:\\.|[^"\\\n])*"', '""', text)
    return re.sub(r"//[^\n]*|/\*.*?\*/", "", text, flags=re.DOTALL)


def used_headers(text):
    code = without_comments(text)
    used = {WORDS[name] for name in STANDARD_NAME.findall(code) if name in WORDS}
    return used | {header for header, pattern in OIIO.items() if re.search(pattern, code)}


@functools.lru_cache(maxsize=None)
def file_text(path):
    with open(path) as file:
        return file.read()


def find_header(target, folder):
    """The project's file that an include in `folder` names, or None."""
    paths = [os.path.normpath(os.path.join(place, target)) for place in [folder] + ROOTS]
    return next((path for path in paths if os.path.isfile(path)), None)


def included_headers(text, folder, seen=None):
    """Of a file in `folder`, and of all that it includes as far as that is known here."""
    seen = set() if seen is None else seen
    for target in INCLUDE.findall(text):
        path = find_header(target, folder)
        if (path or target) in seen:
            continue
        seen.add(path or target)
        if path:
            included_headers(file_text(path), os.path.dirname(path), seen)
        else:
            included_headers("".join(f"#include <{header}>\n" for header in BRINGS.get(target, [])), folder, seen)
    return seen


def include_faults(path, text):
    for header in sorted(used_headers(text) - included_headers(text, os.path.dirname(path))):
        yield f"{path}: uses what is in <{header}> and does not include it"


def first_groups(pattern, text):
    return {name for found in pattern.findall(text) for name in ((found,) if isinstance(found, str) else found) if name}


def called_functions(text):
    """Names of functions at namespace scope that a file calls and that are not its own."""
    code = without_comments(text)
    own = {"static_assert"}.union(*(first_groups(pattern, code) for pattern in (FUNCTION, MEMBER, VARIABLE)))
    own |= {name for line in USING.findall(code) for name in re.findall(r"::(\w+)(?=[,;])", line)}
    # Of OIIO's namespaces and of classes, which begin with a capital, and of std.
    return {name for space, name in CALL.findall(code)
            if name not in own and space not in ("std", "OIIO") and not space[:1].isupper()}


def files():
    for root in ROOTS:
        for folder, _, names in os.walk(root):
            for name in sorted(names):
                if name.endswith((".h", ".cpp")):
                    yield os.path.normpath(os.path.join(folder, name))


@functools.lru_cache(maxsize=None)
def declared_functions():
    """{name: headers}, without names that some class has for a member too."""
    headers, members = collections.defaultdict(set), set()
    for path in files():
        if path.endswith(".h"):
            code = without_comments(file_text(path))
            members |= first_groups(MEMBER, code)
            for name in first_groups(FUNCTION, code):
                headers[name].add(path)
    return {name: paths for name, paths in headers.items() if name not in members}


def function_faults(path, text):
    included = included_headers(text, os.path.dirname(path))
    declared = declared_functions()
    for name in sorted(called_functions(text)):
        if name in declared and not name.startswith("__") and path not in declared[name] and not declared[name] & included:
            header = " or ".join(sorted(os.path.relpath(header, SOURCE) for header in declared[name]))
            yield f"{path}: calls {name}() and does not include {header}"


class Includes(unittest.TestCase):
    maxDiff = None

    def test_files_include_what_they_use(self):
        faults = []
        for path in files():
            faults += include_faults(path, file_text(path))
            faults += function_faults(path, file_text(path))
        self.assertEqual(faults, [])

    def test_a_missing_header_is_found(self):
        for text, count in [("std::vector<int> a;\n", 1), ("#include <vector>\nstd::vector<int> a;\n", 0),
                            ("OIIO::ImageBuf a;\n", 1), ("#include <OpenImageIO/imagebufalgo.h>\nImageBuf a;\n", 0),
                            ("// std::vector\n", 0), ('f("std::vector");\n', 0),
                            ("#include <vmlight/base/params.h>\nstd::string a;\n", 0)]:
            self.assertEqual(len(list(include_faults("a.cpp", text))), count, text)

    def test_a_function_without_its_header_is_found(self):
        self.assertGreater(len(declared_functions()), 500)
        for text, count in [("int a = parallel_items(1, 1, f);\n", 1),
                            ("#include <vmlight/base/parallel.h>\nint a = parallel_items(1, 1, f);\n", 0),
                            ("int a = vmlight::parallel_items(1, 1, f);\n", 1), ("other.parallel_items(1);\n", 0),
                            ("int a = OIIO::parallel_items(1);\n", 0), ("int parallel_items(int);\n", 0),
                            ("    const auto parallel_items = [] {};\n    parallel_items();\n", 0),
                            ("// parallel_items(1)\n", 0)]:
            self.assertEqual(len(list(function_faults("a.cpp", text))), count, text)


if __name__ == "__main__":
    unittest.main()
