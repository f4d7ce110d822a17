# SPDX-License-Identifier: Apache-2.0
"""Names in unnamed namespaces suit unity builds, which compile several files as one, whichever files those are. Two files of
a group must not define the same name there, and a name there must not hide one of a header that another file uses.

Run as: unity_names_test.py"""
import collections
import functools
import os
import re
import unittest

from class_names_test import NOT_CODE, SOURCE

TEST_HEADERS = ["lib", "plugins", "tests/cli", "tests/hard", "tests/support", "tests/unit"]
INCLUDE = re.compile(r'^\s*#\s*include\s*[<"]([^>"]+)[>"]', re.MULTILINE)
MACRO = re.compile(r"[A-Z][A-Z0-9_]*")
CLASS = re.compile(r"(enum class|enum struct|enum|class|struct|union)\b\s*(\w*)\s*(?:final)?\s*(?::[^:].*)?", re.DOTALL)
USING, ALIAS, FUNCTION, OTHER = "using", "alias", "function", "other"
UNNAMED, ENUM, BODY = "(unnamed)", "(enum)", "(body)"

# `detail` of a function: the least and the most arguments; of an alias: its text.
Declaration = collections.namedtuple("Declaration", "scope kind name detail")


def argument_counts(text):
    """Of a function, from after its opening parenthesis."""
    depth, count, optional, any_text = 0, 1, 0, False
    for part in re.split(r"([(),=])", text):
        if part == ")" and depth == 0:
            break
        depth += {"(": 1, ")": -1}.get(part, 0)
        count += part == "," and depth == 0
        optional += part == "=" and depth == 0
        any_text |= part.strip() not in ("", "void")
    return (count - optional, count) if any_text else (0, 0)


def declared_names(text):
    """(kind, name, detail) of each name that one declaration at namespace scope declares."""
    whole = " ".join(text.split())
    text = re.sub(r"\[\[.*?\]\]", " ", text, flags=re.DOTALL)
    text = re.sub(r"->|<<|<=|>=", " ", text)
    while (shorter := re.sub(r"<[^<>]*>", " ", text)) != text:
        text = shorter
    text = re.sub(r"\b(?:alignas|decltype|noexcept|__attribute__)\s*\(+[^()]*(?:\([^()]*\)[^()]*)*\)+", " ", text)
    text = re.sub(r"\b(?:template|inline|static|constexpr|const|extern|HWY_\w+|VMLIGHT_\w+)\b", " ", text)
    text = " ".join(text.split())
    if not text or text[0] in "),:" or re.match(r"friend\b|static_assert\b", text) or "operator" in text:
        return []
    if found := re.match(r"(?:using (\w+) =|namespace (\w+) =|using [\w:]*\b(\w+)$)", text):
        return [(USING if found[3] else ALIAS, found[1] or found[2] or found[3], whole)]
    if text.startswith("using namespace"):
        return []
    if found := CLASS.fullmatch(text):
        return [(ENUM if found[1] == "enum" else OTHER, found[2], None)]
    head = re.split(r"(?<![=!<>])=(?!=)", text, maxsplit=1)[0]
    if found := re.search(r"([\w:~]+) ?\(", head):
        name = found[1]
        return [] if "::" in name or MACRO.fullmatch(name) else [(FUNCTION, name, argument_counts(text[found.end():]))]
    words = [re.findall(r"[\w:]+", part) for part in re.sub(r"\[[^\]]*\]", "", head).split(",")]
    if len(words[0]) < 2:
        return []
    return [(OTHER, some[-1], None) for some in words if some and "::" not in some[-1]]


def declarations(text):
    """What a file declares at namespace scope."""
    text = NOT_CODE.sub(lambda found: " " if found[0].startswith("/") else " 0 ", text)
    text = re.sub(r"^[ \t]*#.*(?:\\\n.*)*$", "", text, flags=re.MULTILINE)
    scopes, found, before = [], [], ""
    for part in re.split(r"([{};])", text):
        if part not in ("{", "}", ";"):
            before = part
            continue
        is_outside = BODY not in scopes and ENUM not in scopes
        names = declared_names(before) if is_outside and part != "}" else []
        namespace = re.search(r"\bnamespace\b\s*([\w:]*)\s*$", before)
        if part == "{" and namespace and is_outside:
            scopes += [scope for scope in namespace[1].split("::") if scope] or [UNNAMED]
            scopes.append(len(namespace[1].split("::")))
        else:
            found += [Declaration(scope_of(scopes), *name) for name in names if name[1]]
            if part == "{":
                scopes.append(ENUM if names and names[0][0] == ENUM else BODY)
            elif part == "}":
                last = scopes.pop()
                if last == ENUM:
                    values = re.findall(r"(?:^|,)\s*(\w+)", before)
                    found += [Declaration(scope_of(scopes), OTHER, value, None) for value in values]
                elif last != BODY:
                    del scopes[-last:]
        before = ""
    return found


def scope_of(scopes):
    return "::".join(scope for scope in scopes if isinstance(scope, str))


@functools.lru_cache(maxsize=None)
def text_of(path):
    with open(os.path.join(SOURCE, path), encoding="utf-8") as file:
        return file.read()


@functools.lru_cache(maxsize=None)
def declarations_of(path):
    return declarations(text_of(path))


@functools.lru_cache(maxsize=None)
def code_of(path):
    return NOT_CODE.sub(" 0 ", text_of(path))


@functools.lru_cache(maxsize=None)
def direct_headers(path):
    """The project's headers that a file includes."""
    found = []
    for target in INCLUDE.findall(text_of(path)):
        places = [os.path.dirname(path), *TEST_HEADERS]
        paths = [os.path.normpath(os.path.join(place, target)) for place in places]
        found += [header for header in paths if os.path.isfile(os.path.join(SOURCE, header))][:1]
    return found


def headers_of(path, seen=None):
    seen = set() if seen is None else seen
    for header in direct_headers(path):
        if header not in seen:
            seen.add(header)
            headers_of(header, seen)
    return seen


def may_share_a_name(first, second):
    """Functions that no call can confuse, and aliases of the same."""
    if first.kind != second.kind or first.kind not in (FUNCTION, ALIAS):
        return False
    a, b = first.detail, second.detail
    return a == b if first.kind == ALIAS else a[1] < b[0] or b[1] < a[0]


def clashes(files):
    """What is wrong between {path: its declarations}."""
    unnamed = collections.defaultdict(list)
    for path, names in files.items():
        for one in names:
            if UNNAMED in one.scope and one.kind != USING:
                unnamed[one.scope, one.name].append((path, one))
    for (_, name), found in sorted(unnamed.items()):
        for at, (path, one) in enumerate(found):
            for other_path, other in found[:at]:
                if path != other_path and not may_share_a_name(one, other):
                    yield f"{name} is defined in unnamed namespaces of {other_path} and {path}: rename one"


def uses(path, one):
    """Whether a file names what a header declares so, without saying of which namespace."""
    text = code_of(path)
    space = re.escape(one.scope.split("::")[-1])
    is_open = re.search(rf"\bnamespace\s+(?:\w+::)*{space}\s*[;{{]", text)
    return is_open and re.search(rf"(?<![\w.>:]){one.name}\b" + (r"\s*\(" if one.kind == FUNCTION else ""), text)


def hidden_names(paths):
    """Names in unnamed namespaces, for which other files of the group would no longer find those of headers."""
    users = collections.defaultdict(list)  # {name: (header, what it declares, files that include it)}
    headers = {path: headers_of(path) for path in paths}
    for header in sorted(set().union(*headers.values())):
        for one in declarations_of(header):
            if one.scope and UNNAMED not in one.scope and one.kind != USING:
                users[one.name].append((header, one, [path for path in paths if header in headers[path]]))
    own = {path: {one.name for one in declarations_of(path) if UNNAMED in one.scope and one.kind != USING} for path in paths}
    for path in paths:
        for name in sorted(own[path]):
            for header, one, others in users[name]:
                hidden = [other for other in others if other != path and name not in own[other] and uses(other, one)]
                if hidden:
                    yield f"{name} of {path} hides that of {header} from {hidden[0]}: rename it"


def passes(code, name):
    """Whether code names a function without arguments, as when it passes it on: then the function must have no overload."""
    return re.search(rf"(?<![\w.>:]){name}\b(?!\s*[({{:=])", code)


def overloaded_values(paths):
    """Functions in unnamed namespaces that a file passes, and that headers of other files of the group overload."""
    headers = sorted(set().union(*(headers_of(path) for path in paths)))
    declared = {one.name: header for header in headers for one in declarations_of(header)
                if one.kind == FUNCTION and UNNAMED not in one.scope}
    for path in paths:
        for one in declarations_of(path):
            if one.kind == FUNCTION and UNNAMED in one.scope and one.name in declared and passes(code_of(path), one.name):
                yield f"{one.name}, which {path} passes, is overloaded in {declared[one.name]}: rename it"


def is_alone(path):
    """Files that are never compiled with others: those that are compiled once for each instruction set."""
    return "hwy/foreach_target.h" in text_of(path)


def groups():
    """{name: files that may be compiled as one}: the rooms of the library, and the programs."""
    found = collections.defaultdict(list)
    for top, depth in ("lib/vmlight", 9), ("plugins", 2), ("tests", 2):
        for folder, _, names in os.walk(os.path.join(SOURCE, top)):
            group = "/".join(os.path.relpath(folder, SOURCE).split(os.sep)[:depth])
            paths = [os.path.relpath(os.path.join(folder, name), SOURCE) for name in sorted(names) if name.endswith(".cpp")]
            found[group] += [path for path in paths if not is_alone(path)]
    for group in "tests/fuzz", "tests/consumer":
        found.pop(group, None)  # a program for each file
    return {group: paths for group, paths in found.items() if len(paths) > 1}


class UnityNames(unittest.TestCase):
    maxDiff = None

    def test_files_that_may_be_compiled_as_one_do_not_clash(self):
        all_groups = groups()
        self.assertGreater(len(all_groups), 20)
        faults = []
        for paths in all_groups.values():
            faults += clashes({path: declarations_of(path) for path in paths})
            faults += hidden_names(paths)
            faults += overloaded_values(paths)
        self.assertEqual(sorted(set(faults)), [])

    def test_names_are_found(self):
        text = """namespace a::b { namespace {
            struct One { int x; }; class Two final : public c::Three { void hidden(); }; enum class Kind { none };
            enum { red, green = 2 }; using Four = std::map<int, int>; using c::five; template <class T> void six(T, int = 1);
            constexpr double kSeven = 7; double kEight { 8 }; const char* nine[] = { "ten", "eleven;" };
            std::vector<std::pair<int, int>> twelve() { int local = 0; return {}; }
            // int thirteen;
            } int fourteen(); } int One::outside() { } TEST(A, B) { int inside; }"""
        found = declarations(text)
        self.assertEqual([one.name for one in found],
                         ["One", "Two", "Kind", "red", "green", "Four", "five", "six", "kSeven", "kEight", "nine", "twelve",
                          "fourteen"])
        self.assertEqual({one.scope for one in found[:-1]}, {f"a::b::{UNNAMED}"})
        self.assertEqual(found[-1].scope, "a::b")
        self.assertEqual([one.detail for one in found if one.kind == FUNCTION], [(1, 2), (0, 0), (0, 0)])

    def test_functions_that_are_passed_are_found(self):
        for code, is_passed in [("sort(a, b, near);", True), ("near<int>(1);", True), ("int near(int x) { return x; }", False),
                                ("near (2);", False), ("other.near, other::near, nearer", False)]:
            self.assertEqual(bool(passes(code, "near")), is_passed, code)

    def test_clashes_are_found(self):
        for one, other, count in [("int a();", "double a();", 1), ("int a();", "int a(int);", 0),
                                  ("int a(int = 1);", "int a();", 1), ("struct A {};", "class A;", 1),
                                  ("using b::A;", "using b::A;", 0), ("using A = int;", "using A = long;", 1),
                                  ("using A = b<int>;", "using A = b<long>;", 1), ("using A = b<int>;", "using A = b<int>;", 0),
                                  ("using A = int;", "using A = int;", 0), ("int a;", "int b;", 0)]:
            files = {path: declarations(f"namespace {{ {text} }}") for path, text in (("1", one), ("2", other))}
            self.assertEqual(len(list(clashes(files))), count, (one, other))


if __name__ == "__main__":
    unittest.main()
