// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/man_page.h>

#include <vmlight/base/format.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

// Text that roff prints as it is: no escapes, no hyphens for '-', no requests at the start of a line.
std::string escaped(const std::string& text)
{
    std::string roff;
    for (const char c : text) {
        if ((c == '.' || c == '\'') && (roff.empty() || roff.back() == '\n'))
            roff += "\\&";
        if (c == '\\')
            roff += "\\e";
        else if (c == '-')
            roff += "\\-";
        else if (c == '\'')
            roff += "\\(aq";
        else
            roff += c;
    }
    return roff;
}

std::string option_paragraph(const CommandLine::Option& option)
{
    std::string text = format(".TP\n\\fB{}\\fR", escaped(option.flag()));
    if (!option.metavar.empty())
        text += format(" \\fI{}\\fR", escaped(option.metavar));
    text += "\n" + escaped(option.help) + "\n";
    if (option.choices.empty())
        return text;
    text += ".RS\n";
    for (const Choice& choice : option.choices)
        text += format(".TP\n\\fB{}\\fR\n{}\n", escaped(choice.word), escaped(choice.meaning));
    return text + ".RE\n";
}

std::string see_also(const std::string& name)
{
    std::vector<std::string> others;
    for (const std::string other : { "makecfem", "makelightmap", "makevismap", "oiiotool", "vmcost" })
        if (other != name)
            others.push_back("\\fB" + other + "\\fR(1)");
    return OIIO::Strutil::join(others, ",\n") + "\n";
}

} // namespace

std::string man_page(const CommandLine& line)
{
    std::string text
        = format(".TH {} 1 \"\" \"vmlight {}\" \"vmlight\"\n", OIIO::Strutil::upper(line.name), VMLIGHT_VERSION_STRING);
    text += format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.nf\n", line.name, escaped(line.purpose));
    for (const std::string& synopsis : line.synopses())
        text += escaped(synopsis) + "\n";
    text += ".fi\n.SH OPTIONS\n";
    for (const CommandLine::Section& section : line.sections()) {
        text += ".SS " + escaped(section.heading.substr(0, section.heading.rfind(':'))) + "\n";
        for (const CommandLine::Option* option : section.options)
            text += option_paragraph(*option);
    }
    text += ".SH EXAMPLES\n.nf\n" + escaped(line.example) + "\n.fi\n";
    text += ".SH EXIT STATUS\n.TP\n0\nsuccess\n.TP\n1\nthe job failed\n.TP\n2\nwrong usage\n";
    return text + ".SH SEE ALSO\n" + see_also(line.name);
}

} // namespace vmlight
