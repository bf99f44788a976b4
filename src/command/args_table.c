/* Arguments of the edits. */
#include "command/args.h"

static const char *wrap_name(int i)
{
    static const char *const names[] = { "periodic", "clamp-u", "clamp-v", "clamp" };
    return i < 4 ? names[i] : NULL;
}

static const char *fit_name(int i)
{
    return i == 0 ? "table" : NULL;
}

static const char *brush_mode_name(int i)
{
    return i < WR_BRUSH_MODE_COUNT ? wr_brush_modes[i].name : NULL;
}

const WrArgSpec wr_args_table[] = {
    { PLACE("WxH"), .type = WR_ARG_SIZE, .low = 1, .high = WR_FIELD_MAX, .unit = "texels",
      .help = "columns and rows" },
    { .name = "wrap",
      .type = WR_ARG_CHOICE,
      .choice = wrap_name,
      .fallback_text = "periodic",
      .help = "what lies beyond the edges: the table again, or its edge for u, for v, for both" },
    { 0 }
};

const WrArgSpec wr_args_fill[] = { { PLACE("F"), .type = WR_ARG_NUMBER, .low = -WR_BIG_HEIGHT,
                                     .high = WR_BIG_HEIGHT, .help = "the height" },
                                   { 0 } };

const WrArgSpec wr_args_grid[] = { { .name = "cells",
                                     .type = WR_ARG_SIZE,
                                     .shape = "MxN",
                                     .low = 1,
                                     .high = WR_FIELD_MAX,
                                     .fallback = NUMBERS(8, 8),
                                     .help = "cells across and down" },
                                   { .name = "width",
                                     .type = WR_ARG_NUMBER,
                                     .low = 0,
                                     .high = WR_FIELD_MAX,
                                     .fallback = NUMBERS(8),
                                     .unit = "texels",
                                     .help = "of the lines" },
                                   { .name = "low",
                                     .type = WR_ARG_NUMBER,
                                     .low = -WR_BIG_HEIGHT,
                                     .high = WR_BIG_HEIGHT,
                                     .fallback = NUMBERS(0),
                                     .help = "height of the cells" },
                                   { .name = "high",
                                     .type = WR_ARG_NUMBER,
                                     .low = -WR_BIG_HEIGHT,
                                     .high = WR_BIG_HEIGHT,
                                     .fallback = NUMBERS(1),
                                     .help = "height of the lines" },
                                   { 0 } };

const WrArgSpec wr_args_image[] = {
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "any picture" },
    { .name = "fit",
      .type = WR_ARG_CHOICE,
      .choice = fit_name,
      .help =
          "resample the picture to the table's size; without it the table takes the picture's" },
    { .name = "sha256",
      .type = WR_ARG_SHA256,
      .help = "of the file: another content is then an error" },
    { 0 }
};

const WrArgSpec wr_args_open[] = { { PLACE("FILE"), .type = WR_ARG_PATH, .help = "a document" },
                                   { .name = "sha256",
                                     .type = WR_ARG_SHA256,
                                     .help = "of the file: another content is then an error" },
                                   { 0 } };

#define BRUSH_ARGS                                                                                 \
    { .name = "radius",                                                                            \
      .type = WR_ARG_NUMBER,                                                                       \
      .low = 0,                                                                                    \
      .high = 1e9,                                                                                 \
      .fallback = NUMBERS(16),                                                                     \
      .unit = "texels",                                                                            \
      .help = "from the centre to where nothing changes" },                                        \
        { .name = "hardness",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = 1,                                                                               \
          .fallback = NUMBERS(0.5),                                                                \
          .help = "part of the radius that is fully covered" },                                    \
        { .name = "strength",                                                                      \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0.1),                                                                \
          .help = "how much the centre changes" },                                                 \
        { .name = "mode",                                                                          \
          .type = WR_ARG_CHOICE,                                                                   \
          .choice = brush_mode_name,                                                               \
          .fallback_text = "raise",                                                                \
          .help = "raise or lower by the strength, or move to a height by at most the strength" }, \
        { .name = "to",                                                                            \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .fallback = NUMBERS(0),                                                                  \
          .help = "the height that mode=to moves to" },                                            \
    {                                                                                              \
        0                                                                                          \
    }

const WrArgSpec wr_args_dab[] = { { PLACE("u,v"), .type = WR_ARG_TUPLE, .components = 2,
                                    .low = -1e9, .high = 1e9, .help = "the centre; v up" },
                                  BRUSH_ARGS };

static const WrComponent sample_parts[] = {
    { "u", -1e9, 1e9, false },        { "v", -1e9, 1e9, false },
    { "pressure", -1e9, 1e9, false }, { "tilt_x", -1e9, 1e9, false },
    { "tilt_y", -1e9, 1e9, false },   { "seconds", -1e9, 1e9, false },
};

const WrArgSpec wr_args_stroke[] = {
    { .name = "points",
      .type = WR_ARG_LIST,
      .required = true,
      .components = 6,
      .parts = sample_parts,
      .counts = TUPLE_OF(2) | TUPLE_OF(3) | TUPLE_OF(5) | TUPLE_OF(6),
      .rows_low = 1,
      .rows_high = WR_POINTS_MAX,
      .shape = "u,v[,pressure[,tilt_x,tilt_y[,seconds]]];...",
      .help = "the pen's samples in order; pressure is clamped to 0..1, tilt to -1..1" },
    BRUSH_ARGS
};
