/* options.h - parsers of export options about the arrangement of files, used in rows of wr_export_kinds. Private
   to this module. */
#pragma once
#include <stdbool.h>

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
            "FILE.json beside it, with all that its label tells; left out: off, but on of .raw, "  \
            ".r16, .r32",                                                                          \
            wr_export_set_sidecar                                                                  \
    }

/* Options of all maps that are computed from the table. */
#define WR_OPTION_SHEET                                                                            \
    { "lay", "plain, half-drop, brick or hex",                                                     \
      "two cells side by side, the second rolled by half; two rows, likewise; hex: the cell's "    \
      "sides stand at 60 degrees, as a rectangle; left out: plain",                                \
      wr_export_set_lay },                                                                         \
        { "repeat", "MxN", "the cell, or what is laid, so often; left out: 1x1",                   \
          wr_export_set_repeat },                                                                  \
        { "resize", "WIDTHxHEIGHT or pot",                                                         \
          "texels of what leaves; pot: the nearest powers of two; left out: as many as there are", \
          wr_export_set_resize },                                                                  \
        { "filter", "box, linear, catmull or lanczos3", "of resize; left out: lanczos3",           \
          wr_export_set_filter },                                                                  \
        { "atlas", "FILE;FILE...", "these cells beside the document's own, in one file",           \
          wr_export_set_atlas },                                                                   \
    {                                                                                              \
        "margin", "TEXELS",                                                                        \
            "around each cell of an atlas, of what lies beyond its edges; left "                   \
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
