// SPDX-License-Identifier: Apache-2.0
#include <vmlight/cli/man_page.h>

#include <vmlight/base/format.h>
#include <vmlight/base/text.h>
#include <vmlight/version.h>

#include <OpenImageIO/strutil.h>

namespace vmlight {
namespace {

std::string option_paragraph(const CommandLine::Option& option)
{
    std::string text = format(".TP\n\\fB{}\\fR", roff_text(option.flag()));
    if (!option.metavar.empty())
        text += format(" \\fI{}\\fR", roff_text(option.metavar));
    text += "\n" + roff_text(option.help) + "\n";
    if (option.choices.empty())
        return text;
    text += ".RS\n";
    for (const Choice& choice : option.choices)
        text += format(".TP\n\\fB{}\\fR\n{}\n", roff_text(choice.word), roff_text(choice.meaning));
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

std::string roff_text(const std::string& text)
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

std::string man_page(const CommandLine& line)
{
    std::string text
        = format(".TH {} 1 \"\" \"vmlight {}\" \"vmlight\"\n", in_capitals(line.name), VMLIGHT_VERSION_STRING);
    text += format(".SH NAME\n{} \\- {}\n.SH SYNOPSIS\n.nf\n", line.name, roff_text(line.purpose));
    for (const std::string& synopsis : line.synopses())
        text += roff_text(synopsis) + "\n";
    text += ".fi\n.SH OPTIONS\n";
    for (const CommandLine::Section& section : line.sections()) {
        text += ".SS " + roff_text(section.heading.substr(0, section.heading.rfind(':'))) + "\n";
        for (const CommandLine::Option* option : section.options)
            text += option_paragraph(*option);
    }
    text += ".SH EXAMPLES\n.nf\n" + roff_text(line.example) + "\n.fi\n";
    text += ".SH EXIT STATUS\n.TP\n0\nsuccess\n.TP\n1\nthe job failed\n.TP\n2\nwrong usage\n";
    return text + ".SH SEE ALSO\n" + see_also(line.name);
}

} // namespace vmlight
