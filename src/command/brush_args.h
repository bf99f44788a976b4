/* brush_args.h - argument rows shared by all painting commands. Private to src/command. */
#pragma once
#include "command/args.h"
#include "field/wrap.h"

#include <stdbool.h>

const char *wr_brush_mode_name(int i); /* word i of mode=, NULL past the last */
/* includes the names of the arguments that the mode uses */
void wr_brush_mode_explain(int i, WrText *text);
extern const WrArgSpec wr_args_brush[]; /* the last row has name NULL */

/* ---- the brush ---- */

/* Choice of the heights that a flood fill compares. */
#define PAINT_ARGS                                                                                 \
    { .name = "strength",                                                                          \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = -WR_BIG_HEIGHT,                                                                       \
      .high = WR_BIG_HEIGHT,                                                                       \
      .fallback = NUMBERS(0.1),                                                                    \
      .help = "how much the centre changes" },                                                     \
        { .name = "mode",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .choice = wr_brush_mode_name,                                                            \
          .explain = wr_brush_mode_explain,                                                        \
          .fallback_text = "raise",                                                                \
          .help = "what it does" },                                                                \
        { .name = "to",                                                                            \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0),                                                                  \
          .help = "a height, for the modes that go by one" },                                      \
        { .name = "opacity",                                                                       \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .fallback = NUMBERS(1),                                                                  \
          .help = "how much of the whole counts" },                                                \
        { .name = "reach",                                                                         \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .fallback = NUMBERS(0),                                                                  \
          .unit = "texels",                                                                        \
          .help = "how far the modes that look around see; 0: an eighth of the radius, at least "  \
                  "1" },                                                                           \
    {                                                                                              \
        .name = "source", .type = WR_ARG_TUPLE, .components = 2, .shape = "du,dv", .low = -1e6,    \
        .high = 1e6, .help = "clone: the heights come from u + du, v + dv"                         \
    }

/* ---- shapes ---- */

#define POINT(name_, help_)                                                                        \
    {                                                                                              \
        .name = name_, .type = WR_ARG_TUPLE, .required = true, .components = 2, .shape = "u,v",    \
        .low = -WR_SELECT_REACH, .high = WR_SELECT_REACH, .help = help_                            \
    }
