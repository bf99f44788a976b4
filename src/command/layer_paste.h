/* layer_paste.h - paste of a picture as a new layer at a position, for the command `layer paste`. Private to
   src/command. */
#pragma once
#include "command/args.h"
#include "field/field.h"

/* Insert a layer above the active one. It holds the picture of the line's FILE; its coverage is the picture's alpha.
   Makes it the active layer and clears the selection. On failure the document is unchanged. layer: a new layer
   without texels; ownership passes to the function. */
bool wr_layer_paste(WrSession *session, WrCall *call, WrLayer layer, WrError *err);

#define WR_PASTE_ARGS                                                                              \
    { PLACE("FILE"), .type = WR_ARG_PATH, .help = "what `copy` wrote, or any picture" },           \
        { .name = "at",                                                                            \
          .type = WR_ARG_TUPLE,                                                                    \
          .components = 2,                                                                         \
          .low = -1e6,                                                                             \
          .high = 1e6,                                                                             \
          .shape = "u,v",                                                                          \
          .help = "where its middle lies; left out, in the middle of the table" },                 \
        { .name = "size",                                                                          \
          .type = WR_ARG_NUMBER,                                                                   \
          .low = 0,                                                                                \
          .high = WR_FIELD_MAX,                                                                    \
          .unit = "texels",                                                                        \
          .help = "how wide it becomes; left out, a texel for a pixel" },                          \
    {                                                                                              \
        .name = "sha256", .type = WR_ARG_SHA256,                                                   \
        .help = "of the file: another content is then an error"                                    \
    }
