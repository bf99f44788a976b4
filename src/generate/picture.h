/* picture.h - heights from pictures.
   Private to this module. */
#pragma once
#include "base/enum_rows.h"
#include "generate/sheet.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct WrError WrError;
typedef struct WrGenerateJob WrGenerateJob;
typedef struct WrImage WrImage;
typedef struct WrImageLabel WrImageLabel;
typedef struct WrImageRequest WrImageRequest;
typedef struct WrParamValue WrParamValue;
typedef struct WrParams WrParams;
typedef struct WrRelief WrRelief;

/* Methods to make a picture seamless on the periodic axes of the sheet. blend: subtracts the smoothest
   function with the jump at the edges: the periodic component of Moisan (J. Math. Imaging Vis. 39,
   2011). Texels keep their positions; a slope across the whole picture is removed. cut: overlaps its
   ends, cuts along the path of least difference, and evens out the rest using the slopes on both sides
   (Poisson). Detail stays sharp. */
#define WR_SEAMLESS_WAYS(X)                                                                        \
    X(WR_SEAMLESS_OFF, "off")                                                                      \
    X(WR_SEAMLESS_BLEND, "blend")                                                                  \
    X(WR_SEAMLESS_CUT, "cut")
typedef enum WrSeamless { WR_SEAMLESS_WAYS(WR_WORD_ID) } WrSeamless;
extern const char *const wr_seamless_words[];

/* The sheet keeps its size for OFF and BLEND. CUT needs a picture that is larger by the overlap
 * on each periodic axis and returns one of width x height. BLEND preserves the
 * mean. Errors: out of memory, "cancelled". */
bool wr_picture_blend(WrSheet *sheet, const WrGenerateJob *job, WrError *err);
bool wr_picture_cut(WrSheet *sheet, int width, int height, const WrGenerateJob *job, WrError *err);

/* Resizes a picture (with the table's wraps) to the job's size, seamless by that method. */
bool wr_picture_fit(WrSheet *sheet, WrSeamless seamless, const WrGenerateJob *job, WrError *err);

#define WR_P_FILE(h)                                                                               \
    {                                                                                              \
        .name = "file", .label = "File", .help = (h), .unit = "", .kind = WR_PARAM_FILE,           \
        .positional = true                                                                         \
    }
/* Parameters that select a part of a file. */
#define WR_P_CHANNELS(name_, also_)                                                                \
    { .name = name_,                                                                               \
      .also = also_,                                                                               \
      .label = "Channels",                                                                         \
      .help = "for an EXR file: a channel (Depth.Z) or a layer of channels (diffuse)",             \
      .unit = "",                                                                                  \
      .kind = WR_PARAM_TEXT,                                                                       \
      .fallback_text = "" },                                                                       \
    {                                                                                              \
        .name = "part", .label = "Part",                                                           \
        .help = "for a file with several parts: number, from 1, or name; or the frame of an "      \
                "animation",                                                                       \
        .unit = "", .kind = WR_PARAM_TEXT, .fallback_text = ""                                     \
    }
/* Option to use the values' range stored by the program in its own files. */
#define WR_PICTURE_LABELS(X) X(WR_LABELS_READ, "read") X(WR_LABELS_IGNORE, "ignore")
enum { WR_PICTURE_LABELS(WR_WORD_ID) };
#define WR_P_LABELS                                                                                \
    WR_P_CHOICE("labels", "Labels", WR_LABELS_READ, wr_picture_labels,                             \
                "read: use the metadata that export stored in the file; ignore: do not")
extern const char *const wr_picture_labels[];
/* The effective label, after a remark if it is invalid; NULL: none. */
const WrImageLabel *wr_picture_label(const WrParams *params, const WrImage *image,
                                     const WrGenerateJob *job);
/* Reads the picture of a row with `file`, `part` and channels of that name; adds a remark on the
   selection. wish: further options; its channel and part are replaced. */
WrImage *wr_picture_read(const WrParams *params, const char *channels, WrImageRequest wish,
                         const WrGenerateJob *job, WrError *err);
/* Adds remarks on differences from the file's pixels. */
#define WR_P_SEAMLESS(value)                                                                       \
    WR_P_CHOICE("seamless", "Seamless", value, wr_seamless_words,                                  \
                "method of matching opposite edges. blend: levels them; cut: overlaps and cuts")

/* ---- rows ---- */

#define WR_PICTURE(name)                                                                           \
    extern const WrParam wr_params_##name[];                                                       \
    bool wr_picture_##name(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,    \
                           WrError *err)
WR_PICTURE(photo);   /* picture_generators.c */
WR_PICTURE(normals); /* normals.c */
WR_PICTURE(paste);   /* picture_generators.c */
WR_PICTURE(svg);     /* svg_generators.c */
WR_PICTURE(path);
#undef WR_PICTURE
