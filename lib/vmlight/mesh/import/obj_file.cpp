// SPDX-License-Identifier: Apache-2.0
#include <vmlight/mesh/import/obj_file.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text_format.h>
#include <vmlight/mesh/import/mesh_builder.h>
#include <vmlight/mesh/import/obj_text.h>

#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

namespace vmlight::obj {
namespace {

using Imath::V2f;
using Imath::V3d;
using Imath::V3f;
using OIIO::string_view;

class Parser
{
public:
    explicit Parser(File& dst)
        : m_file(dst)
    {
    }

    // False, with the reason in error().
    bool parse(const std::string& text);
    const std::string& error() const { return m_error; }

private:
    using Handler = void (Parser::*)(const Statement&);

    void vertex(const Statement& statement)
    {
        if (!numbers(statement, 3, 3))
            return;
        m_file.positions.push_back(V3d(m_numbers[0].value, m_numbers[1].value, m_numbers[2].value));
        m_file.rounded_positions.push_back(V3f(m_numbers[0].rounded, m_numbers[1].rounded, m_numbers[2].rounded));
        m_ends_part = true;
    }

    void uv(const Statement& statement)
    {
        if (!numbers(statement, 1, 2)) // the second is 0 in textures of one dimension
            return;
        if (!std::isfinite(m_numbers[0].value) || !std::isfinite(m_numbers[1].value))
            m_error = format("line {} has non-finite texture coordinates: {}", statement.line, quoted(statement));
        m_file.uvs.push_back(V2f(m_numbers[0].rounded, m_numbers[1].rounded));
    }

    void normal(const Statement& statement)
    {
        if (numbers(statement, 3, 3))
            m_file.normals.push_back(V3f(m_numbers[0].rounded, m_numbers[1].rounded, m_numbers[2].rounded));
    }

    void face(const Statement& statement);

    void object(const Statement& statement)
    {
        m_object = name_in(statement.arguments);
        m_has_object = true;
        if (m_is_group_used)
            m_groups.clear();
        m_is_group_used = false;
        m_is_placed = false;
        m_ends_part = true;
    }

    void group(const Statement& statement)
    {
        m_groups = OIIO::Strutil::splits(name_in(statement.arguments));
        m_is_group_used = false;
        m_is_placed = false;
    }

    void smoothing(const Statement& statement)
    {
        m_has_smoothing = true;
        string_view rest = without_comment(statement.arguments);
        const std::string word = next_word(rest);
        TextNumber number;
        if (word.empty() || word == "off" || word == "null" || (parse_number(word, number) && number.value == 0))
            m_state.smoothing = kFlatGroup;
        else // a word is a group of its own, as is a number that no group can have
            m_state.smoothing = number.value >= 1 && number.value < kSmoothGroup ? uint32_t(number.value) : 1;
    }

    void material(const Statement& statement)
    {
        const auto [entry, is_new]
            = m_material_numbers.emplace(name_in(statement.arguments), int(m_file.materials.size()));
        if (is_new)
            m_file.materials.push_back(entry->first);
        m_state.material = entry->second;
    }

    void library(const Statement& statement)
    {
        m_file.libraries.push_back({ name_in(statement.arguments), statement.line });
    }

    void ignored(const Statement& statement)
    {
        auto& all = m_file.ignored;
        if (std::find(all.begin(), all.end(), statement.keyword) == all.end())
            all.push_back(statement.keyword);
    }

    // Set m_numbers to the first `most` numbers of a statement that must have `least`; others are 0.
    bool numbers(const Statement& statement, size_t least, size_t most);
    // An index of a corner, where `count` are defined so far; 0, with m_error, if it cannot be one.
    int32_t index(string_view word, const Statement& statement, size_t count, const char* what);
    int node_of(const std::string& name, int parent);
    void place();
    void check_faces();

    File& m_file;
    std::string m_error;
    TextNumber m_numbers[3];
    State m_state;
    std::vector<std::string> m_groups;
    std::map<std::pair<int, std::string>, int> m_node_numbers; // by parent and name
    std::map<std::string, int> m_material_numbers;
    std::string m_object;
    bool m_has_object = false, m_is_group_used = false, m_is_placed = false;
    bool m_has_smoothing = false, m_ends_part = false;
};

bool Parser::numbers(const Statement& statement, size_t least, size_t most)
{
    string_view rest = without_comment(statement.arguments);
    for (size_t i = 0; i < most; ++i) {
        m_numbers[i] = {};
        const string_view word = next_word(rest);
        if ((word.empty() && i >= least) || parse_number(word, m_numbers[i]))
            continue;
        m_error
            = format("cannot read as OBJ: line {} must have {} numbers: {}", statement.line, most, quoted(statement));
        return false;
    }
    return true;
}

int32_t Parser::index(string_view word, const Statement& statement, size_t count, const char* what)
{
    const bool is_negative = !word.empty() && word[0] == '-';
    const string_view digits = word.substr(is_negative ? 1 : 0);
    if (digits.empty() || digits.find_first_not_of("0123456789") != string_view::npos) {
        m_error = format("cannot read as OBJ: line {} has a corner that is not one of 1, 1/1, 1//1 and 1/1/1: {}",
                         statement.line, quoted(statement));
        return 0;
    }
    int64_t number = 0;
    for (const char digit : digits)
        number = std::min<int64_t>(number * 10 + (digit - '0'), int64_t(1) << 40);
    if (number == 0)
        m_error = format("cannot read as OBJ: line {}: a face uses {} 0, but they count from 1: {}", statement.line,
                         what, quoted(statement));
    else if (is_negative && number > int64_t(count))
        m_error = format("cannot read as OBJ: line {}: a face uses {} -{}, but there are only {} before it: {}",
                         statement.line, what, number, count, quoted(statement));
    const int64_t result = is_negative ? int64_t(count) - number : number - 1;
    return int32_t(std::min<int64_t>(result, std::numeric_limits<int32_t>::max())); // check_faces() finds it
}

void Parser::face(const Statement& statement)
{
    string_view rest = without_comment(statement.arguments);
    for (string_view word = next_word(rest); !word.empty() && m_error.empty(); word = next_word(rest)) {
        Corner corner { -1, -1, -1 };
        const size_t slash = std::min(word.find('/'), word.size());
        const string_view behind = word.substr(std::min(slash + 1, word.size()));
        const size_t second = std::min(behind.find('/'), behind.size());
        const string_view uv = behind.substr(0, second);
        const string_view normal = behind.substr(std::min(second + 1, behind.size()));
        corner.vertex = index(word.substr(0, slash), statement, m_file.positions.size(), "vertex");
        if (!uv.empty())
            corner.uv = index(uv, statement, m_file.uvs.size(), "texture coordinate");
        if (!normal.empty())
            corner.normal = index(normal, statement, m_file.normals.size(), "normal");
        m_file.corners.push_back(corner);
    }
    if (m_file.corners.size() > std::numeric_limits<uint32_t>::max())
        m_error = "cannot read as OBJ: more than 4294967295 corners";
    if (m_ends_part && !m_file.faces.empty())
        ++m_state.part;
    m_ends_part = false;
    m_is_group_used = true;
    if (!m_is_placed)
        place();
    const auto fields = [](const State& s) { return std::tie(s.node, s.material, s.smoothing, s.part); };
    if (m_file.states.empty() || fields(m_file.states.back()) != fields(m_state))
        m_file.states.push_back(m_state);
    m_file.faces.push_back(
        { uint32_t(m_file.corners.size()), uint32_t(statement.line), uint32_t(m_file.states.size() - 1) });
}

int Parser::node_of(const std::string& name, int parent)
{
    const auto [entry, is_new] = m_node_numbers.emplace(std::pair(parent, name), int(m_file.nodes.size()));
    if (is_new)
        m_file.nodes.push_back({ name, parent, false });
    return entry->second;
}

// The faces that follow are of the object and groups that hold now. Only those that have faces become nodes.
void Parser::place()
{
    m_is_placed = true;
    m_state.node = m_has_object ? node_of(m_object, -1) : -1;
    for (const std::string& name : m_groups)
        m_state.node = node_of(name, m_state.node);
}

// Faces may come before what they use.
void Parser::check_faces()
{
    uint32_t begin = 0;
    for (const Face& face : m_file.faces) {
        for (; begin < face.end; ++begin) {
            const Corner& corner = m_file.corners[begin];
            const std::tuple<const char*, int32_t, size_t> uses[]
                = { { "vertex", corner.vertex, m_file.positions.size() },
                    { "texture coordinate", corner.uv, m_file.uvs.size() },
                    { "normal", corner.normal, m_file.normals.size() } };
            for (const auto& [what, index, count] : uses)
                if (index >= 0 && size_t(index) >= count) {
                    m_error = format("cannot read as OBJ: line {}: a face uses {} {}, but there are only {}", face.line,
                                     what, int64_t(index) + 1, count);
                    return;
                }
        }
    }
}

bool Parser::parse(const std::string& text)
{
    static const std::map<string_view, Handler> handlers {
        { "v", &Parser::vertex },       { "vt", &Parser::uv },        { "vn", &Parser::normal },
        { "f", &Parser::face },         { "fo", &Parser::face },      { "o", &Parser::object },
        { "g", &Parser::group },        { "s", &Parser::smoothing },  { "usemtl", &Parser::material },
        { "mtllib", &Parser::library }, { "surf", &Parser::ignored }, { "bzp", &Parser::ignored },
        { "bsp", &Parser::ignored },    { "cdp", &Parser::ignored },  { "call", &Parser::ignored },
    };
    Statements statements(text);
    Statement statement;
    while (m_error.empty() && statements.next(statement)) {
        const auto handler = handlers.find(statement.keyword);
        if (handler != handlers.end())
            (this->*handler->second)(statement);
    }
    if (m_error.empty())
        check_faces();
    if (!m_has_smoothing)
        for (State& state : m_file.states)
            state.smoothing = kSmoothGroup;
    return m_error.empty();
}

} // namespace

bool parse(File& dst, const std::string& text, std::string& error)
{
    Parser parser(dst);
    const bool good = parser.parse(text);
    error = parser.error();
    return good;
}

} // namespace vmlight::obj
