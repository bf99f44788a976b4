/* one_line.hpp - reduction of a library's message to one line of a reason. C++, for the modules.
   Private to this module. */
#pragma once
#include <cstddef>
#include <cstdio>
#include <string>

inline void one_line(char *reason, std::size_t size, const std::string &text)
{
    std::string line;
    for (char c : text) {
        bool space = static_cast<unsigned char>(c) <= ' ';
        if (!space) line += c;
        else if (!line.empty() && line.back() != ' ') line += ' ';
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
    std::snprintf(reason, size, "%s", line.c_str());
}
