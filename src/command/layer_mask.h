/* layer_mask.h - sources of layer masks for the command `layer mask`. Private to src/command. */
#pragma once
#include "command/args.h"

/* Set or remove the mask of layer `index`, as the line states. */
bool wr_layer_mask_make(WrSession *session, const WrCall *call, int index, WrError *err);

extern const char *const wr_mask_sources[];

#define WR_MASK_ARGS                                                                               \
    { .name = "from",                                                                              \
      .type = WR_ARG_CHOICE,                                                                       \
      .required = true,                                                                            \
      .words = wr_mask_sources,                                                                    \
      .help =                                                                                      \
          "what is selected, no mask, a mask that shows all or nothing, where the composite's "    \
          "height or slope lies in a range, or the present mask turned over" },                    \
        { .name = "low",                                                                           \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "of height and slope: lower end, a height or degrees" },                         \
        { .name = "high",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = -WR_BIG_HEIGHT,                                                                   \
          .high = WR_BIG_HEIGHT,                                                                   \
          .help = "upper end" },                                                                   \
    {                                                                                              \
        .name = "soft", .type = WR_ARG_NUMBER, .low = 0, .high = WR_BIG_HEIGHT,                    \
        .help = "over how much it fades beyond the ends; left out, not at all"                     \
    }
