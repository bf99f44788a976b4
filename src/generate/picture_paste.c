/* An unchanged picture at a position: pasted copies, and pictures from other programs. */
#include "base/error.h"
#include "base/memory.h"
#include "field/field.h"
#include "generate/tile_builder.h"
#include "generate/picture.h"
#include "generate/transform_piece.h"
#include "image/image.h"

#include <math.h>

#define MIRRORS(X)                                                                                 \
    X(MIRROR_NONE, "none")                                                                         \
    X(MIRROR_U, "u") X(MIRROR_V, "v") X(MIRROR_UV, "uv")
enum { MIRRORS(WR_WORD_ID) };
static const char *const mirrors[] = { MIRRORS(WR_WORD) NULL };

const WrParam wr_params_paste[] = {
    WR_P_FILE("of the picture, or of what `copy` wrote"),
    { .name = "at",
      .label = "At",
      .help = "where its middle lies",
      .unit = "",
      .kind = WR_PARAM_TUPLE,
      .fallback = { 0.5, 0.5 },
      .low = -1e6,
      .high = 1e6,
      .soft_low = 0,
      .soft_high = 1,
      .shape = "u,v",
      .components = 2 },
    WR_P_TEXELS("size", "Width", 0, 512, "how wide it becomes; 0: a texel for a pixel"),
    WR_P_NUMBER("angle", "Angle", 0, -36000, 36000, 180, "degrees", "turned anticlockwise"),
    WR_P_CHOICE("mirror", "Mirror", MIRROR_NONE, mirrors, "u: left for right; v: top for bottom"),
    WR_P_CHOICE("filter", "Filter", WR_PLACE_CATMULL, wr_place_filters,
                "how it is read between its pixels, unless they fall on texels"),
    WR_P_SWITCH("transparent", "Transparent", 1, "its alpha says how much of it shows"),
    WR_P_LABELS,
    WR_P_NUMBER("height", "Height", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "of white, or of 1 in floats"),
    WR_P_END
};

static bool put(const WrImage *image, bool alpha, double height, WrField *field,
                const WrGenerateJob *job, WrError *err)
{
    const int n = image->channels, width = image->width;
    float *row = wr_try_alloc((size_t)width, sizeof *row, "a row of a picture", err);
    for (int j = 0; row && j < image->height; j++) {
        const float *pixel = image->data + (size_t)j * (size_t)width * (size_t)n;
        if (wr_progress_cancelled(job->progress)) {
            wr_free(row);
            return wr_fail(err, "cancelled");
        }
        for (int i = 0; i < width; i++, pixel += n) {
            double v = alpha ? (double)pixel[n - 1] : (double)wr_image_luma(pixel, n) * height;
            row[i] = (float)(alpha ? v > 0.0 ? v < 1.0 ? v : 1.0 : 0.0 : v);
        }
        wr_field_write(field, 0, j, width, 1, row, (size_t)width);
    }
    wr_free(row);
    return row != NULL;
}

static WrField *field_of(const WrImage *image, bool alpha, double height, const WrGenerateJob *job,
                         WrError *err)
{
    WrField *field =
        wr_field_new(image->width, image->height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0.0f, err);
    if (!field || put(image, alpha, height, field, job, err)) return field;
    wr_field_free(field);
    return NULL;
}

static bool check_size(double scale, const WrImage *image, double size, WrError *err)
{
    if (scale <= WR_PLACE_SCALE && scale >= 1.0 / WR_PLACE_SCALE) return true;
    return wr_fail(err, "size=%g: must be 1/%g to %g times the picture's %d pixels", size,
                   WR_PLACE_SCALE, WR_PLACE_SCALE, image->width);
}

bool wr_picture_paste(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                      WrError *err)
{
    const WrParams p = { wr_params_paste, values };
    const double *at = wr_param_value(&p, "at")->number, size = wr_param_number(&p, "size");
    const int mirror = wr_param_whole(&p, "mirror");
    WrImage *image = wr_image_read(wr_param_value(&p, "file")->text, err);
    if (!image) return false;
    wr_picture_note(wr_param_value(&p, "file")->text, image, job);
    const double w = image->width, h = image->height, scale = size > 0.0 ? size / w : 1.0;
    bool good = check_size(scale, image, size, err);
    if (good && wr_picture_label(&p, image, job)) wr_image_apply_range(image);
    bool alpha = wr_param_whole(&p, "transparent") == 1 && image->channels % 2 == 0;
    WrField *heights =
        good ? field_of(image, false, wr_param_number(&p, "height"), job, err) : NULL;
    WrField *weight = heights && alpha ? field_of(image, true, 1.0, job, err) : NULL;
    WrPlacing placing = { .heights = heights,
                          .weight = weight,
                          .window = { 0.0, 0.0, w, h },
                          .from = { 0.5 * w, 0.5 * h },
                          .at = { at[0] * wr_field_width(job->like),
                                  (1.0 - at[1]) * wr_field_height(job->like) },
                          .scale = { mirror & 1 ? -scale : scale, mirror & 2 ? -scale : scale },
                          .turn_deg = wr_param_number(&p, "angle"),
                          .filter = (WrPlaceFilter)wr_param_whole(&p, "filter") };
    good = heights && (!alpha || weight) && wr_place(&placing, job, out, err);
    wr_image_free(image);
    wr_field_free(heights);
    wr_field_free(weight);
    return good;
}
