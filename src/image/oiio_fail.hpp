/* oiio_fail.hpp - how what goes wrong in the library is told. C++, part of the module alone.
   Private to this room. */
#pragma once
extern "C" {
#include "image/oiio.h"
}

#include "image/one_line.hpp"

#include <new>
#include <string>

/* Wherever it stands. */
inline void say_instead(std::string &text, const std::string &what, const std::string &instead)
{
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += instead.size())
        text.replace(at, what.size(), instead);
}

/* The message as one line. The caller names the file; the path by which the library knows it is ours alone. */
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

/* Run a function that returns bool; an exception becomes a reason. */
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
