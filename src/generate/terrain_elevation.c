/* Real elevations: images of 16 bits or floats, and raw number files. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "field/field.h"
#include "generate/picture.h"
#include "generate/terrain.h"
#include "generate/terrain_raw.h"
#include "image/fill_missing.h"
#include "image/image.h"
#include "image/sidecar.h"

#include <math.h>
#include <string.h>

#define ORDERS(X) X(LITTLE, "little") X(BIG, "big")
#define MEANINGS(X) X(AUTO, "auto") X(CODE, "code") X(RANGE, "range") X(REAL, "real")
enum { SAMPLE_AUTO }; /* then WrRawKind + 1 */
enum { ORDERS(WR_WORD_ID) };
enum { MEANINGS(WR_WORD_ID) }; /* values= */
static const char *const samples[] = { "auto", WR_RAW_KINDS(WR_WORD) NULL };
static const char *const orders[] = { ORDERS(WR_WORD) NULL };
static const char *const meanings[] = { MEANINGS(WR_WORD) NULL };

const WrParam wr_params_elevation[] = {
    WR_P_FILE("a picture, SRTM elevations (.hgt), or bare numbers (.r16, .raw, .r32)"),
    WR_P_CHANNELS("layer", "channel"),
    { .name = "size",
      .label = "Size",
      .help = "columns x rows of bare numbers; left out, they are a square",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    WR_P_CHOICE("sample", "Numbers", SAMPLE_AUTO, samples,
                "type of raw numbers; auto: u16, or f32 in a file .r32"),
    WR_P_CHOICE("order", "Byte order", LITTLE, orders, "of bare numbers"),
    WR_P_CHOICE(
        "values", "Values", AUTO, meanings,
        "range that is mapped to low..high: all codes of the type, or the smallest and largest "
        "value; real: heights are scale times the values; auto: real for floats, signed integers "
        "and TIFF files that are georeferenced or have a no-data value, else code"),
    WR_P_NUMBER("low", "Low", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "values=code, range: of the lowest"),
    WR_P_NUMBER("high", "High", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "values=code, range: of the highest"),
    WR_P_NUMBER("scale", "Scale", 1, -1e12, 1e12, 10, "table units",
                "values=real: of one unit of the file"),
    WR_P_SWITCH("holes", "Fill holes", 1,
                "fill values without data: NaN, infinity, -9999, -32768, beyond 1e30"),
    WR_P_NUMBER("nodata", "No data", -9999, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 9999, "",
                "another value without data"),
    WR_P_LABELS,
    WR_P_SEAMLESS(WR_SEAMLESS_OFF),
    WR_P_END
};

/* Values of the file. */
typedef struct Elevation {
    WrSheet sheet;
    double most; /* the largest code; 0: floats */
    double least;
    bool can_lack; /* values may represent missing data */
    bool labelled; /* they are heights, according to the file's label */
} Elevation;

static bool read_raw(const WrParams *p, const char *path, const char *ending, const WrWrap wrap[2],
                     Elevation *out, WrError *err)
{
    int sample = wr_param_whole(p, "sample");
    const char *size = wr_param_value(p, "size")->text;
    WrRaw raw = { .kind = sample                       ? (WrRawKind)(sample - 1)
                          : strcmp(ending, "r32") == 0 ? WR_RAW_F32
                                                       : WR_RAW_U16,
                  .big = wr_param_whole(p, "order") == BIG };
    char *bytes = NULL;
    size_t length = 0, limit = (size_t)WR_FIELD_MAX * WR_FIELD_MAX * wr_raw_bytes(raw.kind);
    if (!wr_file_read(path, limit, &bytes, &length, err)) return false;
    bool good = wr_raw_size(size ? size : "", length, &raw, err);
    if (!good) wr_error_prefix(err, "%s: ", path);
    good = good && wr_sheet_new(&out->sheet, raw.width, raw.height, wrap, err);
    if (good) wr_raw_decode(&raw, bytes, out->sheet.z);
    wr_free(bytes);
    out->most = raw.kind == WR_RAW_U16 ? 65535.0 : raw.kind == WR_RAW_I16 ? 32767.0 : 0.0;
    out->least = raw.kind == WR_RAW_I16 ? -32768.0 : 0.0;
    out->can_lack = raw.kind != WR_RAW_U16;
    return good;
}

/* Converts codes to heights with the file's label; other values= must be requested explicitly. */
static bool apply_label(const WrParams *p, WrImage *image, const WrGenerateJob *job)
{
    const char *path = wr_param_value(p, "file")->text;
    const WrImageLabel *label = wr_picture_label(p, image, job);
    if (!label || wr_param_whole(p, "values") != AUTO) return false;
    if (label->kind >= WR_LABEL_NORMAL_UP)
        wr_generate_note(job, "%s: according to its label it is a normal map: see picture normals",
                         path);
    if (!wr_image_apply_range(image)) return false;
    wr_generate_note(job,
                     "%s: its label states the heights of its codes, and they are used "
                     "(labels=ignore reads codes)",
                     path);
    return true;
}

/* Missing values are read as NaN and stay NaN. */
static bool read_picture(const WrParams *p, const char *path, const WrWrap wrap[2],
                         const WrGenerateJob *job, Elevation *out, WrError *err)
{
    const WrImageRequest wish = { .keep_lost = true,
                                  .elevation = wr_param_whole(p, "values") != CODE };
    WrImage *image = wr_picture_read(p, "layer", wish, job, err);
    if (!image) return false;
    bool good = wr_sheet_new(&out->sheet, image->width, image->height, wrap, err);
    out->labelled = good && apply_label(p, image, job);
    out->most = out->labelled ? 0.0 : wr_pixel_last(image->type);
    out->least = 0.0;
    out->can_lack = image->type == WR_PIXEL_F32;
    size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; good && k < count && wr_sheet_goes_on(k); k++) {
        double x = (double)image->data[k * (size_t)image->channels];
        out->sheet.z[k] = out->most > 0.0 ? rint(x * out->most) : x;
    }
    if (good && image->type == WR_PIXEL_U8)
        wr_generate_note(job, "%s has 8 bits: slopes will show steps", path);
    wr_image_free(image);
    return good;
}

static bool fill_holes(const WrParams *p, Elevation *e, const char *path, const WrGenerateJob *job,
                       WrError *err)
{
    size_t count = (size_t)e->sheet.width * (size_t)e->sheet.height;
    bool wanted = wr_param_whole(p, "holes") == 1 && !e->labelled;
    double nodata = wr_param_number(p, "nodata");
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double *z = &e->sheet.z[k];
        bool lost = !isfinite(*z) || fabs(*z) > 1e30;
        if (wanted && *z == nodata) lost = true;
        if (wanted && e->can_lack && (*z == -9999.0 || *z == -32768.0)) lost = true;
        if (lost) *z = NAN;
    }
    int64_t filled = wr_fill_missing(e->sheet.width, e->sheet.height, e->sheet.z, err);
    if (filled == -1) return wr_fail(err, "%s: no elevation is known anywhere in it", path);
    if (filled > 0)
        wr_generate_note(job, "%lld of %zu elevations are not known: filled from their neighbours",
                         (long long)filled, count);
    return filled >= 0;
}

/* Converts values to heights: from low, by high - low over the values' range, or by scale. */
static void bring_to_heights(const WrParams *p, Elevation *e, const WrGenerateJob *job)
{
    int values = wr_param_whole(p, "values");
    double low = wr_param_number(p, "low"), high = wr_param_number(p, "high"), from, to;
    size_t count = (size_t)e->sheet.width * (size_t)e->sheet.height;
    wr_sheet_range(&e->sheet, &from, &to);
    wr_generate_note(job, "%dx%d elevations from %g to %g", e->sheet.width, e->sheet.height, from,
                     to);
    if (values == AUTO) values = e->can_lack || e->labelled ? REAL : CODE;
    if (values == CODE && e->most > 0.0) {
        from = e->least;
        to = e->most;
    }
    double scale = wr_param_number(p, "scale");
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double *z = &e->sheet.z[k];
        if (values == REAL) *z *= scale;
        else *z = to > from ? low + (high - low) * ((*z - from) / (to - from)) : low;
    }
}

bool wr_terrain_elevation(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                          WrError *err)
{
    const WrParams p = { wr_params_elevation, values };
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    const char *path = wr_param_value(&p, "file")->text;
    char ending[16];
    wr_path_ending(path, ending);
    bool raw =
        strcmp(ending, "raw") == 0 || strcmp(ending, "r16") == 0 || strcmp(ending, "r32") == 0;
    Elevation e = { .most = 0.0 };
    const char *size = wr_param_value(&p, "size")->text;
    /* A raw file with a sidecar is read like other images, unless the command describes it. */
    if (raw && !(size && *size) && wr_param_whole(&p, "sample") == 0 && wr_sidecar_is_there(path))
        raw = false;
    if (!raw && size && *size)
        return wr_fail(
            err,
            "size=%s: a picture has its own size; files of raw numbers end in .raw, .r16 "
            "or .r32",
            size);
    bool good = raw ? read_raw(&p, path, ending, wrap, &e, err)
                    : read_picture(&p, path, wrap, job, &e, err);
    good = good && fill_holes(&p, &e, path, job, err);
    if (good) {
        bring_to_heights(&p, &e, job);
        good = wr_picture_fit(&e.sheet, (WrSeamless)wr_param_whole(&p, "seamless"), job, err) &&
               wr_sheet_relief(&e.sheet, job, out, err);
    }
    wr_sheet_fini(&e.sheet);
    return good;
}
