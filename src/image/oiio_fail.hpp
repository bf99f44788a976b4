/* oiio_fail.hpp - how what goes wrong in the library is told. C++, part of the module alone.
   Private to this room. */
#pragma once
extern "C" {
#include "image/oiio.h"
}

#include <cstdio>
#include <new>
#include <string>

/* The message as one line that does not name the file: the caller does. */
inline bool fail(char *reason, std::string text, const std::string &path = std::string())
{
    for (size_t at; !path.empty() && (at = text.find(path)) != std::string::npos;)
        text.replace(at, path.size(), "it");
    std::string line;
    for (char c : text) {
        bool space = static_cast<unsigned char>(c) <= ' ';
        if (!space) line += c;
        else if (!line.empty() && line.back() != ' ') line += ' ';
    }
    while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
    snprintf(reason, WR_OIIO_REASON, "%s", line.c_str());
    return false;
}

/* Run a function that returns bool; an exception becomes a reason. */
template <typename Body> bool guarded(char *reason, Body body)
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return fail(reason, WR_OIIO_NO_MEMORY);
    } catch (const std::exception &problem) {
        return fail(reason, problem.what());
    } catch (...) {
        return fail(reason, "unknown exception in the library");
    }
}
