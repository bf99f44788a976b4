/* Arguments of the edits. */
#include "command/args.h"

static const char *wrap_name(int i)
{
    static const char *const names[] = { "periodic", "clamp-u", "clamp-v", "clamp" };
    return i < 4 ? names[i] : NULL;
}

static const char *labels_name(int i)
{
    static const char *const names[] = { "use", "ignore" };
    return i >= 0 && i < 2 ? names[i] : NULL;
}

static const char *fit_name(int i)
{
    return i == 0 ? "table" : NULL;
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
    WR_ARGS_OF_FILE,
    { .name = "labels",
      .type = WR_ARG_CHOICE,
      .choice = labels_name,
      .fallback_text = "use",
      .help =
          "what export wrote into the file: the heights of its codes, or that it is a normal map" },
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
