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
        "directions", "4, 8, 16 or 32", "number of directions; left out: 16", wr_set_directions    \
    }
#define WR_OPTION_REACH                                                                            \
    {                                                                                              \
        "reach", "TEXELS or all", "largest distance of the horizon, 1..256 texels; left out: all", \
            wr_set_reach                                                                           \
    }
#define WR_OPTION_BEND                                                                             \
    {                                                                                              \
        "full", "CURVATURE or auto",                                                               \
            "curvature of white, in 1 / scene unit; minus that is black; left out: the largest "   \
            "in the map",                                                                          \
            wr_set_full                                                                            \
    }
#define WR_OPTION_PART                                                                             \
    {                                                                                              \
        "part", "signed, convex or concave",                                                       \
            "convex, concave: only ridges or only grooves, bright on black; left out: signed",     \
            wr_set_part                                                                            \
    }
#define WR_OPTION_TOWARD                                                                           \
    {                                                                                              \
        "toward", "DEGREES or all",                                                                \
            "direction from u towards v; the nearest computed one is used; left out: 0",           \
            wr_set_toward                                                                          \
    }
#define WR_OPTION_STEEPEST                                                                         \
    {                                                                                              \
        "full", "SLOPE or auto", "slope of white; left out: the largest in the map",               \
            wr_set_steepest                                                                        \
    }
#define WR_OPTION_RADIUS                                                                           \
    {                                                                                              \
        "radius", "TEXELS",                                                                        \
            "standard deviation of the Gaussian that computes the surroundings; left out: 8",      \
            wr_set_radius                                                                          \
    }
#define WR_OPTION_DEEPEST                                                                          \
    {                                                                                              \
        "full", "DEPTH or auto", "depth of black; left out: the deepest in the map",               \
            wr_set_depth_full                                                                      \
    }
#define WR_OPTION_BOX                                                                              \
    {                                                                                              \
        "box", "TEXELS", "side of the box, odd; left out: 9", wr_set_box                           \
    }
#define WR_OPTION_BASE                                                                             \
    {                                                                                              \
        "base", "ALPHA or material", "roughness of the material itself, 0..1; left out: 0",        \
            wr_set_base                                                                            \
    }
#define WR_OPTION_GROUND                                                                           \
    {                                                                                              \
        "ground", "zero, lowest or HEIGHT", "height that becomes 0; left out: zero", wr_set_ground \
    }
#define WR_OPTION_SCALE                                                                            \
    {                                                                                              \
        "scale", "LENGTH", "height of F = 1; left out: the scene's bump height", wr_set_scale      \
    }
#define WR_OPTION_LOW                                                                              \
    {                                                                                              \
        "low", "HEIGHT", "lower end of white; left out: the middle of the heights' range",         \
            wr_set_mask_low                                                                        \
    }
#define WR_OPTION_HIGH                                                                             \
    {                                                                                              \
        "high", "HEIGHT", "upper end of white; left out: no limit", wr_set_mask_high               \
    }
#define WR_OPTION_FEATHER                                                                          \
    {                                                                                              \
        "feather", "HEIGHT", "width of the fade beyond both ends; left out: 0", wr_set_feather     \
    }
#define WR_OPTION_WORN                                                                             \
    {                                                                                              \
        "full", "CURVATURE or auto",                                                               \
            "curvature of full wear; left out: the one that one texel in 50 exceeds", wr_set_full  \
    }
#define WR_OPTION_THRESHOLD                                                                        \
    {                                                                                              \
        "threshold", "PART", "share of that curvature at which wear begins; left out: 0.2",        \
            wr_set_threshold                                                                       \
    }
#define WR_OPTION_NOISE                                                                            \
    {                                                                                              \
        "noise", "PART", "variation of the threshold by noise, 0..1; left out: 0", wr_set_noise    \
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
        "endian", "little or big", "byte order of .raw, .r16, .r32; left out: little",             \
            wr_export_set_endian                                                                   \
    }
#define WR_OPTION_SIDECAR                                                                          \
    {                                                                                              \
        "sidecar", "on or off",                                                                    \
            "write the metadata to FILE.json as well; left out: off, but on for .raw, .r16, .r32", \
            wr_export_set_sidecar                                                                  \
    }

/* Options of all maps that are computed from the table. */
#define WR_OPTION_SHEET                                                                            \
    { "lay", "plain, half-drop, brick or hex",                                                     \
      "arrangement of cells. half-drop: two cells side by side, the second offset by half its "    \
      "height; brick: two rows, the second offset by half the width; hex: cells at 60 degrees, "   \
      "as a rectangle; left out: plain",                                                           \
      wr_export_set_lay },                                                                         \
        { "repeat", "MxN", "repeats of the cell or the arrangement; left out: 1x1",                \
          wr_export_set_repeat },                                                                  \
        { "resize", "WIDTHxHEIGHT or pot",                                                         \
          "size of the file in texels; pot: the nearest powers of two; left out: the table's",     \
          wr_export_set_resize },                                                                  \
        { "filter", "box, linear, catmull or lanczos3", "of resize; left out: lanczos3",           \
          wr_export_set_filter },                                                                  \
        { "atlas", "FILE;FILE...", "other cells to put into one file with the document's",         \
          wr_export_set_atlas },                                                                   \
    {                                                                                              \
        "margin", "TEXELS",                                                                        \
            "margin around each cell of an atlas, filled with the heights beyond its edges; left " \
            "out: 4",                                                                              \
            wr_export_set_margin                                                                   \
    }
#define WR_OPTION_MIPS                                                                             \
    {                                                                                              \
        "mips", "on or off",                                                                       \
            "also write mip levels FILE_1, FILE_2 and so on, each half as wide and high; left "    \
            "out: off",                                                                            \
            wr_export_set_mips                                                                     \
    }
#define WR_OPTION_BORDER                                                                           \
    {                                                                                              \
        "border", "on or off",                                                                     \
            "one more row and column, a copy of the first, so samples are at i/n; left out: off",  \
            wr_export_set_border                                                                   \
    }
