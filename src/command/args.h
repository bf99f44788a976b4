/* args.h - macros and shared choices for argument rows of the command table. Choices, surfaces and export kinds come
   from the tables of their modules. Private to src/command. */
#pragma once
#include "command/session_internal.h"

#include <stdbool.h>

/* Default numbers. */
#define NUMBERS(...)                                                                               \
    (const double[])                                                                               \
    {                                                                                              \
        __VA_ARGS__                                                                                \
    }
/* A required positional value. */
#define PLACE(x) .name = (x), .positional = true, .required = true
/* Half axes of an ellipse. */
#define WR_ARG_RADII                                                                               \
    {                                                                                              \
        .name = "radii", .type = WR_ARG_TUPLE, .required = true, .components = 2,                  \
        .shape = "ru,rv", .low = 0, .high = WR_SELECT_REACH,                                       \
        .help = "half its width and height, in parts of the cell as u and v"                       \
    }
/* Centre of an ellipse. */
#define WR_ARG_MIDDLE                                                                              \
    .name = "at", .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",         \
    .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = "its middle"
/* The connected region of similar height around a point. */
#define WR_ARGS_FLOOD(of)                                                                          \
    { PLACE("u,v"), .also = "at", .type = WR_ARG_TUPLE,     .components = 2,                       \
      .low = -1e6,  .high = 1e6,  .help = "where it begins" },                                     \
        { .name = "tolerance",                                                                     \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0.01),                                                               \
          .unit = "height units",                                                                  \
          .help = "how far " of " may be from the one at u,v" },                                   \
    {                                                                                              \
        .name = "diagonal", .type = WR_ARG_CHOICE, .words = wr_off_on, .fallback_text = "off",     \
        .help = "on: texels that meet at a corner are connected too"                               \
    }
/* Channel and part of a picture file (WrImageRequest). */
#define WR_ARGS_OF_FILE                                                                            \
    { .name = "layer",                                                                             \
      .also = "channel",                                                                           \
      .type = WR_ARG_TEXT,                                                                         \
      .shape = "NAME",                                                                             \
      .help = "of an EXR file: a channel (Depth.Z) or a layer of them (diffuse); left out, its "   \
              "first colours or grey, else its first channel" },                                   \
    {                                                                                              \
        .name = "part", .type = WR_ARG_TEXT, .shape = "N or NAME",                                 \
        .help = "of a file with several, or a frame of an animation; left out, the first"          \
    }
/* WrCommand.form callback for a list of forms. */
#define WR_FORMS(function, list)                                                                   \
    static bool function(int i, WrForm *out)                                                       \
    {                                                                                              \
        if (i >= (int)(sizeof(list) / sizeof *(list))) return false;                               \
        *out = (list)[i];                                                                          \
        return true;                                                                               \
    }
/* Bit of WrArgSpec.counts: a tuple of a list may have n numbers. */
#define TUPLE_OF(n) (1u << (n))

extern const char *const wr_off_on[]; /* "off", "on" */
