/* channel_packing.h - option parsers of packed maps, which game engines read: red, green, blue and alpha have
   chosen contents, each from 0 to 1. Used in rows of wr_export_kinds.
   Private to this module. */
#pragma once
#include "export/option_parsers.h"

/* Role of channel c, from 0; WR_ROLE_NONE: a number everywhere, or a map without a role. *turned: output, its value is 1 less
   the role's. */
WrMaterialRole wr_export_packed_role(const WrExportOptions *options, int c, bool *turned);

WrExportSet wr_export_set_red, wr_export_set_green, wr_export_set_blue, wr_export_set_alpha;

#define WR_OPTION_PACK                                                                             \
    { "red", "MAP or 0..1",                                                                        \
      "occlusion, roughness, smoothness (1 less roughness), metalness (the material's), height, "  \
      "cavity, curvature, mask or wear, or a number everywhere; left out: occlusion",              \
      wr_export_set_red },                                                                         \
        { "green", "MAP or 0..1", "as for red; left out: roughness", wr_export_set_green },        \
        { "blue", "MAP or 0..1", "as for red; left out: metalness", wr_export_set_blue },          \
    {                                                                                              \
        "alpha", "MAP or 0..1", "as for red; left out: no alpha", wr_export_set_alpha              \
    }
