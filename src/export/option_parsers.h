/* option_parsers.h - parsers of export options about the arrangement of files, used in rows of wr_export_kinds. Private
   to this module. */
#pragma once
#include "export/export.h"

#include <stdbool.h>

/* ---- option parsers of maps, used in the kinds' rows (kinds.c) ---- */

typedef bool WrExportSet(WrExportOptions *options, const char *value, WrError *err);

WrExportSet wr_set_directions, wr_set_reach, wr_set_toward, wr_set_steepest, wr_set_radius,
    wr_set_depth_full, wr_set_full, wr_set_part, wr_set_box, wr_set_base, wr_set_ground,
    wr_set_scale, wr_set_mask_low, wr_set_mask_high, wr_set_feather, wr_set_threshold, wr_set_noise,
    wr_set_grain;

#define WR_OPTION_DIRECTIONS                                                                       \
    {                                                                                              \
        "directions", "4, 8, 16 or 32", "that are looked in; left out: 16", wr_set_directions      \
    }
#define WR_OPTION_REACH                                                                            \
    {                                                                                              \
        "reach", "TEXELS or all", "how far is looked, 1..256 texels; left out: all", wr_set_reach  \
    }
#define WR_OPTION_BEND                                                                             \
    {                                                                                              \
        "full", "CURVATURE or auto",                                                               \
            "value of white, 1 / scene unit, its opposite is black; left out: the largest "        \
            "there is",                                                                            \
            wr_set_full                                                                            \
    }
#define WR_OPTION_PART                                                                             \
    {                                                                                              \
        "part", "signed, convex or concave",                                                       \
            "ridges alone, or grooves alone, are bright on black; left out: signed", wr_set_part   \
    }
#define WR_OPTION_TOWARD                                                                           \
    {                                                                                              \
        "toward", "DEGREES or all",                                                                \
            "the direction, from u towards v, that is nearest to it; left out: 0", wr_set_toward   \
    }
#define WR_OPTION_STEEPEST                                                                         \
    {                                                                                              \
        "full", "SLOPE or auto", "value of white; left out: the largest", wr_set_steepest          \
    }
#define WR_OPTION_RADIUS                                                                           \
    {                                                                                              \
        "radius", "TEXELS", "of the surroundings, a Gaussian's; left out: 8", wr_set_radius        \
    }
#define WR_OPTION_DEEPEST                                                                          \
    {                                                                                              \
        "full", "DEPTH or auto", "depth of black; left out: the deepest", wr_set_depth_full        \
    }
#define WR_OPTION_BOX                                                                              \
    {                                                                                              \
        "box", "TEXELS", "along its sides, odd; left out: 9", wr_set_box                           \
    }
#define WR_OPTION_BASE                                                                             \
    {                                                                                              \
        "base", "ALPHA or material", "of the material itself, 0..1; left out: 0", wr_set_base      \
    }
#define WR_OPTION_GROUND                                                                           \
    {                                                                                              \
        "ground", "zero, lowest or HEIGHT", "height that becomes 0; left out: zero", wr_set_ground \
    }
#define WR_OPTION_SCALE                                                                            \
    {                                                                                              \
        "scale", "LENGTH", "of F = 1; left out: the scene's bump height", wr_set_scale             \
    }
#define WR_OPTION_LOW                                                                              \
    {                                                                                              \
        "low", "HEIGHT", "white from here; left out: the middle of the range", wr_set_mask_low     \
    }
#define WR_OPTION_HIGH                                                                             \
    {                                                                                              \
        "high", "HEIGHT", "white up to here; left out: no end", wr_set_mask_high                   \
    }
#define WR_OPTION_FEATHER                                                                          \
    {                                                                                              \
        "feather", "HEIGHT", "over which it fades beyond; left out: 0", wr_set_feather             \
    }
#define WR_OPTION_WORN                                                                             \
    {                                                                                              \
        "full", "CURVATURE or auto",                                                               \
            "curvature that wears off wholly; left out: exceeded by one texel in 50", wr_set_full  \
    }
#define WR_OPTION_THRESHOLD                                                                        \
    {                                                                                              \
        "threshold", "PART", "of it from which on edges wear; left out: 0.2", wr_set_threshold     \
    }
#define WR_OPTION_NOISE                                                                            \
    {                                                                                              \
        "noise", "PART", "how much noise changes that, 0..1; left out: 0", wr_set_noise            \
    }
#define WR_OPTION_GRAIN                                                                            \
    {                                                                                              \
        "grain", "CELLS", "of the noise across the table; left out: 32", wr_set_grain              \
    }

/* Of normals. */
bool wr_export_set_axes(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_map_size(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_padding(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_strength(WrExportOptions *options, const char *value, WrError *err);

typedef struct WrError WrError;
typedef struct WrExportOptions WrExportOptions;

bool wr_export_set_dither(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_hidden(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_signs(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_uvslopes(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_endian(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_sidecar(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_lay(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_repeat(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_resize(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_filter(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_border(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_mips(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_atlas(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_margin(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_solid_size(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_solid_error(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_thickness(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_triangles(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_edges(WrExportOptions *options, const char *value, WrError *err);
bool wr_export_set_folds(WrExportOptions *options, const char *value, WrError *err);

/* Parses "MxN", whole numbers low..high. */
bool wr_export_parse_size(const char *value, double low, double high, int *a, int *b);

#define WR_OPTION_ENDIAN                                                                           \
    {                                                                                              \
        "endian", "little or big", "order of bytes in .raw, .r16, .r32; left out: little",         \
            wr_export_set_endian                                                                   \
    }
#define WR_OPTION_SIDECAR                                                                          \
    {                                                                                              \
        "sidecar", "on or off",                                                                    \
            "FILE.json beside it, with the content of its label; left out: off, but on for .raw, " \
            ".r16, .r32",                                                                          \
            wr_export_set_sidecar                                                                  \
    }

/* Options of all maps that are computed from the table. */
#define WR_OPTION_SHEET                                                                            \
    { "lay", "plain, half-drop, brick or hex",                                                     \
      "two cells side by side, the second rolled by half; two rows, likewise; hex: the cell's "    \
      "sides stand at 60 degrees, as a rectangle; left out: plain",                                \
      wr_export_set_lay },                                                                         \
        { "repeat", "MxN", "repeats of the cell, or of the arrangement; left out: 1x1",            \
          wr_export_set_repeat },                                                                  \
        { "resize", "WIDTHxHEIGHT or pot",                                                         \
          "texels of the file; pot: the nearest powers of two; left out: the table's",             \
          wr_export_set_resize },                                                                  \
        { "filter", "box, linear, catmull or lanczos3", "of resize; left out: lanczos3",           \
          wr_export_set_filter },                                                                  \
        { "atlas", "FILE;FILE...", "these cells beside the document's own, in one file",           \
          wr_export_set_atlas },                                                                   \
    {                                                                                              \
        "margin", "TEXELS",                                                                        \
            "border around each cell of an atlas, with the heights beyond its edges; left "        \
            "out: 4",                                                                              \
            wr_export_set_margin                                                                   \
    }
#define WR_OPTION_MIPS                                                                             \
    {                                                                                              \
        "mips", "on or off",                                                                       \
            "FILE_1, FILE_2 and so on beside it, each of half as many texels; left out: off",      \
            wr_export_set_mips                                                                     \
    }
#define WR_OPTION_BORDER                                                                           \
    {                                                                                              \
        "border", "on or off",                                                                     \
            "one texel more each way, the last the first again: samples at i/n; left out: off",    \
            wr_export_set_border                                                                   \
    }
