/* oiio_fail.hpp - conversion of library failures to one-line reasons. C++, only in the module.
   Private to this module. */
#pragma once
extern "C" {
#include "image/oiio.h"
}

#include "image/one_line.hpp"

#include <new>
#include <string>

/* Replaces every occurrence. */
inline void say_instead(std::string &text, const std::string &what, const std::string &instead)
{
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size())
        text.replace(at, what.size(), instead);
}

/* Stores the message as one line. The caller names the file; the path used by the library is internal
 * and is removed. */
inline bool fail(char *reason, std::string text, const std::string &path = std::string())
{
    if (!path.empty()) say_instead(text, " (" + path + ")", "");
    for (const char *quote : { "\"", "'", "" }) {
        std::string quoted = quote + path + quote;
        for (const char *before : { "image file ", "file " })
            if (!path.empty()) say_instead(text, before + quoted, "the file");
        if (!path.empty()) say_instead(text, quoted, "the file");
    }
    one_line(reason, WR_CODEC_REASON, text);
    return false;
}

/* Runs a function that returns bool; an exception becomes a reason. */
template <typename Body> bool guarded(char *reason, Body body)
{
    try {
        return body();
    } catch (const std::bad_alloc &) {
        return fail(reason, WR_CODEC_NO_MEMORY);
    } catch (const std::exception &problem) {
        return fail(reason, problem.what());
    } catch (...) {
        return fail(reason, "unknown exception in the library");
    }
}
