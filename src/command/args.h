/* args.h - what rows of arguments are written with. Choices, surfaces and export kinds come from the tables of their
   rooms.
   Layer 6, private to src/command. */
#pragma once
#include "command/inner.h"

#include <stdbool.h>

/* Numbers of a default. */
#define NUMBERS(...)                                                                               \
    (const double[])                                                                               \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
/* A required value without a name. */
#define PLACE(x) .name = (x), .positional = true, .required = true
/* What of a picture file is taken (WrImageWish). */
#define WR_ARGS_OF_FILE                                                                            \
    { .name = "channel",                                                                           \
      .type = WR_ARG_TEXT,                                                                         \
      .shape = "NAME",                                                                             \
      .help = "of an EXR file: a channel (Depth.Z) or a layer of them (diffuse); left out, its "   \
              "first colours or grey, else its first channel" },                                   \
    {                                                                                              \
        .name = "part", .type = WR_ARG_TEXT, .shape = "N or NAME",                                 \
        .help = "of a file with several, or a frame of an animation; left out, the first"          \
    }
/* The function that WrCommand.form asks for, of a list of forms. */
#define WR_FORMS(function, list)                                                                   \
    static bool function(int i, WrForm *out)                                                       \
    {                                                                                              \
        if (i >= (int)(sizeof(list) / sizeof *(list))) return false;                               \
        *out = (list)[i];                                                                          \
        return true;                                                                               \
    }
/* A tuple of a list may have n numbers. */
#define TUPLE_OF(n) (1u << (n))

extern const char *const wr_off_on[]; /* "off", "on" */
