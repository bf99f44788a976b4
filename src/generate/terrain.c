/* Real elevations: images of 16 bits or floats, and raw number files. */
#include "generate/terrain.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/changed_blocks.h"
#include "field/field.h"
#include "generate/picture.h"
#include "generate/sheet.h"
#include "image/fill_missing.h"
#include "image/image.h"
#include "image/sidecar.h"
#include "noise/texel_grid.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

/* ---- elevation files ---- */

#define ORDERS(X) X(LITTLE, "little") X(BIG, "big")
#define MEANINGS(X) X(AUTO, "auto") X(CODE, "code") X(RANGE, "range") X(REAL, "real")
enum { SAMPLE_AUTO }; /* then WrRawKind + 1 */
enum { ORDERS(WR_WORD_ID) };
enum { MEANINGS(WR_WORD_ID) }; /* values= */
static const char *const samples[] = { "auto", WR_RAW_KINDS(WR_WORD) NULL };
static const char *const orders[] = { ORDERS(WR_WORD) NULL };
static const char *const meanings[] = { MEANINGS(WR_WORD) NULL };

const WrParam wr_params_elevation[] = {
    WR_P_FILE("a picture, SRTM elevations (.hgt), or a raw file (.r16, .raw, .r32)"),
    WR_P_CHANNELS("layer", "channel"),
    { .name = "size",
      .label = "Size",
      .help = "columns x rows of a raw file; left out, a square",
      .unit = "",
      .kind = WR_PARAM_TEXT,
      .fallback_text = "" },
    WR_P_CHOICE("sample", "Numbers", SAMPLE_AUTO, samples,
                "number type of a raw file; auto: u16, or f32 for .r32"),
    WR_P_CHOICE("order", "Byte order", LITTLE, orders, "byte order of a raw file"),
    WR_P_CHOICE(
        "values", "Values", AUTO, meanings,
        "range that is mapped to low..high: all codes of the type, or the smallest and largest "
        "value; real: heights are scale times the values; auto: real for floats, signed integers "
        "and TIFF files that are georeferenced or have a no-data value, else code"),
    WR_P_NUMBER("low", "Low", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "values=code, range: height of the lowest value"),
    WR_P_NUMBER("high", "High", 1, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "values=code, range: height of the highest value"),
    WR_P_NUMBER("scale", "Scale", 1, -1e12, 1e12, 10, "table units",
                "values=real: height of one unit of the file"),
    WR_P_SWITCH("holes", "Fill holes", 1,
                "fill values without data: NaN, infinity, -9999, -32768, beyond 1e30"),
    WR_P_NUMBER("nodata", "No data", -9999, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 9999, "",
                "another value that means no data"),
    WR_P_LABELS,
    WR_P_SEAMLESS(WR_SEAMLESS_OFF),
    WR_P_END
};

/* Values of the file. They pass through three meanings: codes of the file (0..most, or least..most of signed integers),
   numbers of floats, and heights in table units after bring_to_heights. Missing ones are NaN between reading and filling. */
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
    good = good && wr_sheet_init(&out->sheet, raw.width, raw.height, wrap, err);
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
    bool good = wr_sheet_init(&out->sheet, image->width, image->height, wrap, err);
    out->labelled = good && apply_label(p, image, job);
    out->most = out->labelled ? 0.0 : wr_pixel_type_max(image->type);
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
    if (filled == -1) return wr_fail(err, "%s: contains no elevation, only no-data values", path);
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
        return wr_fail(err,
                       "size=%s: only for raw files (.raw, .r16, .r32); a picture has its own size",
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

/* ---- Terraces: the present heights quantized to steps ---- */

const WrParam wr_params_terraces[] = {
    WR_P_WHOLE("steps", "Steps", 8, 1, 4096, 32,
               "number of terraces from the lowest to the highest place"),
    WR_P_PART("sharpness", "Sharpness", 0.8,
              "flatness of the terraces; 0 leaves the heights unchanged"),
    WR_P_NUMBER("riser", "Riser", 0.3, 0.01, 1, 1, "",
                "share of a terrace's height over which it rises"),
    WR_P_PART("jitter", "Jitter", 0.3, "irregularity of their edges, in terraces"),
    WR_P_WHOLE("cells", "Cells", 6, 1, 4096, 32, "cells of the jitter's noise across the table"),
    WR_P_PART("uneven", "Height variation", 0.3, "random variation of the terraces' heights"),
    WR_P_SEED,
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Terraces {
    const WrField *from;
    double low, high, steps, sharpness, riser, jitter, uneven;
    uint32_t seed;
    WrOctavesPlan noise;
    WrOrigin across, up;
} Terraces;

/* End of step k, in steps. */
static double bound(const Terraces *t, double k)
{
    if (k <= 0.0 || k >= t->steps) return k;
    uint32_t mixed = wr_mix32(t->seed ^ wr_mix32((uint32_t)(int64_t)k + 0x9e3779b9U));
    return k + t->uneven * 0.8 * (mixed / 4294967296.0 - 0.5);
}

/* x: in steps from the lowest; shifted by `bend` before the quantization and back after it. The riser occupies the upper part
   `riser` of a step: s = 0 on the tread and a smoothstep 3 s^2 - 2 s^3 on the riser, so that the slope is 0 at both of its
   ends. bound() displaces the ends of steps by up to 0.4 steps, so the floor of x can be off by one step in either direction. */
static double cut(const Terraces *t, double x, double bend)
{
    double at = x + bend, k = floor(at);
    if (at < bound(t, k)) k -= 1.0;
    else if (at >= bound(t, k + 1.0)) k += 1.0;
    double from = bound(t, k), to = bound(t, k + 1.0);
    double part = (at - from) / (to - from), s = (part - (1.0 - t->riser)) / t->riser;
    s = s > 0.0 ? s < 1.0 ? s : 1.0 : 0.0;
    double flat = from + (to - from) * s * s * (3.0 - 2.0 * s);
    return x + t->sharpness * (flat - at);
}

/* Noise of a run of texels in a row of the table, from column i of row j before the origin is moved; it ends at the table's
   right edge at the latest. Returns its length. */
static int noise_run(const Terraces *t, const WrGenerateBlock *b, int x, int y, float *n)
{
    const int from_below = b->height - 1 - (b->j + y) - t->up.shift;
    const int j = b->height - 1 - (from_below < 0 ? from_below + b->height : from_below);
    const int column = b->i + x - t->across.shift;
    const int i = column < 0 ? column + b->width : column;
    const int count = b->width - i < b->count_i - x ? b->width - i : b->count_i - x;
    const WrNoiseGrid grid = { b->width, b->height, i, j, count, 1 };
    wr_octaves_grid(&t->noise, &grid, n, NULL, NULL, WR_TILE);
    return count;
}

/* Moving by `origin`: whole texels are rolled, so the same noise reappears bit for bit elsewhere; only the rest below a texel
   moves the noise itself (plan). */
static void cut_block(const void *ctx, const WrGenerateBlock *b, int worker, float *heights,
                      float *cover)
{
    (void)worker, (void)cover;
    const Terraces *t = ctx;
    const double step = (t->high - t->low) / t->steps;
    float n[WR_TILE];
    wr_field_read(t->from, b->i, b->j, b->count_i, b->count_j, heights, WR_TILE);
    if (!(t->high > t->low)) return;
    for (int y = 0; y < b->count_j; y++)
        for (int x = 0, count; x < b->count_i; x += count) {
            count = noise_run(t, b, x, y, n);
            for (int k = 0; k < count; k++) {
                float *z = &heights[y * WR_TILE + x + k];
                const double up = ((double)*z - t->low) / step;
                *z = (float)(t->low + step * cut(t, up, t->jitter * (double)n[k]));
            }
        }
}

static bool plan(Terraces *t, const WrParams *p, WrError *err)
{
    WrOctaves o = wr_octaves_default(2);
    const int texels[] = { t->across.size, t->up.size };
    o.count = 4;
    o.seed = t->seed;
    o.cells[0] = wr_param_number(p, "cells");
    /* Cells of the noise are as square as whole numbers allow: only whole cells per table tile (NUMERICS.md a.6). */
    o.cells[1] = floor(o.cells[0] * texels[1] / texels[0] + 0.5);
    if (o.cells[1] < 1.0) o.cells[1] = 1.0;
    if (!wr_octaves_plan(&o, texels, &t->noise, err)) return false;
    const double rest[] = { t->across.rest / t->across.size, t->up.rest / t->up.size };
    for (int k = 0; k < t->noise.used; k++)
        for (int a = 0; a < 2; a++) {
            WrOctave *octave = &t->noise.octave[k];
            octave->offset[a] = wr_noise_reduce(octave->offset[a] - octave->frequency[a] * rest[a],
                                                octave->frequency[a]);
        }
    return true;
}

/* Without a change of the range each texel depends on its own height. */
static void clear_unchanged(const Terraces *t, WrGenerateJob *job)
{
    const WrMadeBefore *before = job->before;
    float low, high;
    if (!before) return;
    wr_field_range(before->heights, &low, &high);
    if (low != t->low || high != t->high) return;
    const WrFieldChange change = { before->heights, t->from };
    memset(before->wanted, 0,
           (size_t)wr_field_tiles_u(t->from) * (size_t)wr_field_tiles_v(t->from));
    wr_mark_changes(&change, 1, 0, before->wanted);
    job->wanted = before->wanted;
}

bool wr_terrain_terraces(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                         WrError *err)
{
    const WrParams p = { wr_params_terraces, values };
    const WrParamValue *origin = wr_param_value(&p, "origin");
    WrGenerateJob building = *job;
    float low, high;
    wr_field_range(job->like, &low, &high);
    Terraces t = { .from = job->like,
                   .low = low,
                   .high = high,
                   .steps = wr_param_number(&p, "steps"),
                   .sharpness = wr_param_number(&p, "sharpness"),
                   .riser = wr_param_number(&p, "riser"),
                   .jitter = wr_param_number(&p, "jitter"),
                   .uneven = wr_param_number(&p, "uneven"),
                   .seed = wr_param_seed(&p),
                   .across = wr_origin(wr_field_width(job->like), origin->number[0]),
                   .up = wr_origin(wr_field_height(job->like), origin->number[1]) };
    if (!plan(&t, &p, err)) return false;
    clear_unchanged(&t, &building);
    return wr_generate_build(&building, cut_block, &t, false, 0.0, out, err);
}

/* ---- fractal ---- */

/* Mountains: sums of noise whose fine octaves are weighted by location: strong at heights, on ridges,
   and on gentle slopes. With n_k the octaves (about -1..1), a_k = ratio^-k and weights w_k,

     fbm      v = sum of a_k w_k n_k
     billow   v = sum of a_k w_k (2 |n_k| - 1)
     ridged   v = sum of a_k w_k s_k, s_k = (1 - |n_k|)^2,   m_(k+1) = min(1, gain m_k s_k)
     hybrid   v = sum of a_k w_k s_k, s_k = n_k + offset,    m_(k+1) = min(1, gain m_k s_k)

   (Musgrave's multifractals; in the first two m_k = 1), and

     w_k = m_k (1 - altitude + altitude h) / (1 + erosion |d|^2)

   where h = 0..1 is the relative height of the sum of the previous octaves between their lowest and
   highest, and d is the sum of the slopes of the octaves so far, each per own cell: steep places stay
   smooth. */

#define TYPES(X) X(FBM, "fbm") X(BILLOW, "billow") X(RIDGED, "ridged") X(HYBRID, "hybrid")
enum { TYPES(WR_WORD_ID) };
static const char *const types[] = { TYPES(WR_WORD) NULL };

const WrParam wr_params_fractal[] = {
    WR_P_CHOICE("type", "Type", RIDGED, types,
                "fbm: round hills; billow: lumps; ridged: ridges; hybrid: plains with mountains"),
    WR_P_WHOLE("cells", "Cells", 3, 1, 4096, 16, "cells of the first octave across the table"),
    WR_P_WHOLE("octaves", "Octaves", 9, 1, WR_OCTAVES_MAX, 12,
               "largest number of octaves; those with cells below two texels are left out"),
    WR_P_ABOVE("ratio", "Falloff", 2.1, 1, 64, 4, "",
               "amplitude ratio of successive octaves: higher is smoother"),
    WR_P_ABOVE("step", "Lacunarity", 2, 1, 64, 4, "",
               "frequency ratio of successive octaves; rounded to whole cells"),
    WR_P_NUMBER("offset", "Offset", 0.7, 0, 10, 2, "", "type=hybrid: share of mountains"),
    WR_P_NUMBER("gain", "Gain", 2, 0, 100, 4, "",
                "type=ridged, hybrid: strength of fine octaves beside the ridges"),
    WR_P_PART("altitude", "By altitude", 0.5, "attenuation of finer octaves towards low ground"),
    WR_P_NUMBER("erosion", "Erosion", 0.5, 0, 100, 2, "", "attenuation of finer octaves on slopes"),
    WR_P_NUMBER("warp", "Warp", 0, -8, 8, 1, "cells",
                "distance by which noise displaces the ground sideways; slow"),
    WR_P_ABOVE("curve", "Curve", 1, 0, 16, 4, "",
               "exponent of the heights; above 1 widens valleys"),
    WR_P_PART("sea", "Sea", 0, "sea level, as a share of the height; lower ground is flat"),
    WR_P_SEED,
    WR_P_HEIGHT,
    WR_P_NUMBER("level", "Level", 0, -WR_PARAM_HEIGHT, WR_PARAM_HEIGHT, 1, "table units",
                "level of the lowest place"),
    WR_P_ORIGIN,
    WR_P_END
};

typedef struct Fractal {
    int type, octaves;
    double ratio, offset, gain, altitude, erosion, warp;
    bool slopes;
    WrOctavesPlan octave[WR_OCTAVES_MAX]; /* one each, amplitude 1 */
    WrOctavesPlan bend[2];
    double low[WR_OCTAVES_MAX], high[WR_OCTAVES_MAX]; /* of the sum before octave k */
    WrOrigin across, up;
    WrSheet *sheet;
} Fractal;

/* One texel's sum while octaves are added. */
typedef struct Sum {
    double v, m, du, dv;
} Sum;

/* One octave of the sum above; du, dv collect the slopes of the plain noise, not of the weighted one, so that the weights of
   all octaves at a texel depend on the same terrain. */
static void add_octave(const Fractal *f, int k, double amplitude, double n, double nu, double nv,
                       Sum *sum)
{
    const WrOctave *octave = &f->octave[k].octave[0];
    double weight = sum->m;
    if (k > 0) {
        double h = (sum->v - f->low[k]) / (f->high[k] - f->low[k]);
        h = h > 0.0 ? h < 1.0 ? h : 1.0 : 0.0;
        weight *= 1.0 - f->altitude + f->altitude * h * h * (3.0 - 2.0 * h);
    }
    if (f->slopes) {
        sum->du += nu / octave->frequency[0];
        sum->dv += nv / octave->frequency[1];
        weight /= 1.0 + f->erosion * (sum->du * sum->du + sum->dv * sum->dv);
    }
    double s = n, ridge = 1.0 - fabs(n);
    if (f->type == BILLOW) s = 1.0 - 2.0 * ridge;
    if (f->type == RIDGED) s = ridge > 0.0 ? ridge * ridge : 0.0;
    if (f->type == HYBRID) s = n + f->offset;
    sum->v += amplitude * weight * s;
    if (f->type == RIDGED || f->type == HYBRID) {
        double m = f->gain * sum->m * s;
        sum->m = m > 0.0 ? m < 1.0 ? m : 1.0 : 0.0;
    }
}

/* ---- plans ---- */

static bool plan_fractal(Fractal *f, const WrParams *p, const WrGenerateJob *job, WrError *err)
{
    int width = wr_field_width(job->like), height = wr_field_height(job->like);
    WrOctaves o = wr_octaves_default(2);
    WrOctavesPlan all;
    const int texels[] = { width, height };
    o.count = wr_param_whole(p, "octaves");
    o.ratio = f->ratio;
    o.step = wr_param_number(p, "step");
    o.seed = wr_param_seed(p);
    o.cells[0] = wr_param_number(p, "cells");
    o.cells[1] = floor(o.cells[0] * height / width + 0.5);
    if (o.cells[1] < 1.0) o.cells[1] = 1.0;
    if (!wr_octaves_plan(&o, texels, &all, err)) return false;
    if (all.used == 0)
        wr_generate_note(job, "nothing is left: cells=%g is finer than two texels a cell",
                         o.cells[0]);
    /* A coarse preview with warp cannot use the grid kernels, so it stops after four octaves. */
    f->octaves = job->coarse && f->warp != 0.0 && all.used > 4 ? 4 : all.used;
    for (int k = 0; k < all.used; k++) {
        f->octave[k] = all;
        f->octave[k].used = 1;
        f->octave[k].octave[0] = all.octave[k];
        f->octave[k].octave[0].amplitude = 1.0;
    }
    o.count = 2;
    for (int a = 0; a < 2; a++) {
        o.seed = wr_mix32(o.seed + 0x51ed270bU);
        if (!wr_octaves_plan(&o, texels, &f->bend[a], err)) return false;
    }
    f->warp /= o.cells[0];
    return true;
}

/* Moves by a fraction of a texel; whole ones are rolled. */
static void move(WrOctavesPlan *one, const Fractal *f)
{
    const double by[] = { f->across.rest / f->across.size, f->up.rest / f->up.size };
    for (int k = 0; k < one->used; k++)
        for (int a = 0; a < 2; a++) {
            WrOctave *octave = &one->octave[k];
            octave->offset[a] = wr_noise_reduce(octave->offset[a] - octave->frequency[a] * by[a],
                                                octave->frequency[a]);
        }
}

/* Range of the sum of the first k octaves, for `altitude`: two thirds of the noise's bound, which is
 * seldom exceeded. */
static void span(Fractal *f)
{
    double low = 0.0, high = 0.0, amplitude = 1.0;
    for (int k = 0; k < f->octaves; k++) {
        f->low[k] = low;
        f->high[k] = high;
        double few = f->type == FBM ? -0.6 : f->type == BILLOW ? -1.0 : 0.0;
        double many = f->type == FBM      ? 0.6
                      : f->type == BILLOW ? 0.3
                      : f->type == RIDGED ? 1.0
                                          : f->offset + 0.6;
        low += few * amplitude;
        high += many * amplitude;
        amplitude /= f->ratio;
    }
}

/* ---- rows ---- */

static void octave_row(const Fractal *f, int k, const WrNoiseGrid *grid, const double *place,
                       float *n)
{
    int width = grid->width;
    float *nu = n + width, *nv = nu + width;
    if (f->warp == 0.0) {
        wr_octaves_grid(&f->octave[k], grid, n, f->slopes ? nu : NULL, f->slopes ? nv : NULL,
                        (size_t)width);
        return;
    }
    for (int i = 0; i < width; i++) {
        double slope[2];
        n[i] = (float)wr_octaves_at(&f->octave[k], place + 2 * i, slope);
        nu[i] = (float)slope[0];
        nv[i] = (float)slope[1];
    }
}

/* Noise positions of the row's texels. n: [2 width] scratch */
static void bend_row(const Fractal *f, const WrNoiseGrid *grid, double *place, float *n)
{
    for (int a = 0; a < 2; a++) {
        wr_octaves_grid(&f->bend[a], grid, n, NULL, NULL, (size_t)grid->width);
        for (int i = 0; i < grid->width; i++) {
            double at = a == 0 ? (i + 0.5) / grid->width : 1.0 - (grid->j + 0.5) / grid->height;
            place[2 * i + a] = at + f->warp * (double)n[i];
        }
    }
}

/* Octaves are outside, texels inside: a row of noise is computed by the grid kernel, and the state of every texel's sum waits
   in `sums`. scratch n: noise and its two slopes, [3][width]. */
static void fill_rows(const void *ctx, int first, int end)
{
    const Fractal *f = ctx;
    int width = f->sheet->width, height = f->sheet->height;
    float *n = wr_alloc((size_t)width, 3 * sizeof *n);
    double *place = wr_alloc((size_t)width, 2 * sizeof *place);
    Sum *sums = wr_alloc((size_t)width, sizeof *sums);
    for (int j = first; j < end; j++) {
        WrNoiseGrid grid = { width, height, 0, j, width, 1 };
        double amplitude = 1.0;
        for (int i = 0; i < width; i++) sums[i] = (Sum){ .m = 1.0 };
        if (f->warp != 0.0) bend_row(f, &grid, place, n);
        for (int k = 0; k < f->octaves; k++, amplitude /= f->ratio) {
            octave_row(f, k, &grid, place, n);
            for (int i = 0; i < width; i++)
                add_octave(f, k, amplitude, (double)n[i], (double)n[width + i],
                           (double)n[2 * width + i], &sums[i]);
        }
        int to = height - 1 - (height - 1 - j + f->up.shift) % height;
        for (int i = 0; i < width; i++)
            f->sheet->z[(size_t)to * (size_t)width + (size_t)((i + f->across.shift) % width)] =
                sums[i].v;
    }
    wr_free(n);
    wr_free(place);
    wr_free(sums);
}

/* Maps 0..1 of the whole to level..level + height. */
static void shape(const WrParams *p, WrSheet *sheet)
{
    double low, high, height = wr_param_number(p, "height"), level = wr_param_number(p, "level");
    double curve = wr_param_number(p, "curve"), sea = wr_param_number(p, "sea");
    size_t count = (size_t)sheet->width * (size_t)sheet->height;
    wr_sheet_range(sheet, &low, &high);
    for (size_t k = 0; k < count && wr_sheet_goes_on(k); k++) {
        double t = high > low ? (sheet->z[k] - low) / (high - low) : 0.0;
        if (curve != 1.0) t = wr_pow(t, curve);
        sheet->z[k] = level + height * (t > sea ? t : sea);
    }
}

bool wr_terrain_fractal(const WrParamValue *values, const WrGenerateJob *job, WrRelief *out,
                        WrError *err)
{
    const WrParams p = { wr_params_fractal, values };
    const WrWrap wrap[] = { wr_field_wrap_u(job->like), wr_field_wrap_v(job->like) };
    const WrParamValue *origin = wr_param_value(&p, "origin");
    WrSheet sheet = { .z = NULL };
    Fractal *f = wr_alloc(1, sizeof *f);
    *f = (Fractal){ .type = wr_param_whole(&p, "type"),
                    .ratio = wr_param_number(&p, "ratio"),
                    .offset = wr_param_number(&p, "offset"),
                    .gain = wr_param_number(&p, "gain"),
                    .altitude = wr_param_number(&p, "altitude"),
                    .erosion = wr_param_number(&p, "erosion"),
                    .warp = wr_param_number(&p, "warp"),
                    .across = wr_origin(wr_field_width(job->like), origin->number[0]),
                    .up = wr_origin(wr_field_height(job->like), origin->number[1]),
                    .sheet = &sheet };
    f->slopes = f->erosion > 0.0;
    bool good =
        plan_fractal(f, &p, job, err) &&
        wr_sheet_init(&sheet, wr_field_width(job->like), wr_field_height(job->like), wrap, err);
    if (good) {
        for (int k = 0; k < f->octaves; k++) move(&f->octave[k], f);
        for (int a = 0; a < 2; a++) move(&f->bend[a], f);
        span(f);
        good = wr_sheet_run(&sheet, job, true, fill_rows, f, err);
    }
    if (good) {
        shape(&p, &sheet);
        good = wr_sheet_relief(&sheet, job, out, err);
    }
    wr_sheet_fini(&sheet);
    wr_free(f);
    return good;
}

/* ---- terrains ---- */

/* reads: it changes the present heights. */
#define ROW(n, l, h, p, m, r)                                                                      \
    {                                                                                              \
        .family = "terrain", .name = (n), .label = (l), .help = (h), .blend = "replace",           \
        .params = (p), .make = (m), .reads = (r)                                                   \
    }

const WrGenerator wr_terrains[] = {
    ROW("fractal", "Fractal",
        "mountains from sums of noise, with finer detail on high ground and less on slopes",
        wr_params_fractal, wr_terrain_fractal, false),
    ROW("elevation", "Elevation",
        "real elevations from a 16-bit or float picture, or from a raw file", wr_params_elevation,
        wr_terrain_elevation, false),
    ROW("hydraulic", "Rain",
        "erosion by rain, which cuts valleys and fills hollows; no ground is lost. Drops fall at "
        "fixed places of the table, so a shifted table erodes differently",
        wr_params_hydraulic, wr_terrain_hydraulic, true),
    ROW("thermal", "Scree",
        "thermal erosion: ground slides where it is steeper than the talus angle; no ground is "
        "lost",
        wr_params_thermal, wr_terrain_thermal, true),
    ROW("terraces", "Terraces", "terraces cut into the heights", wr_params_terraces,
        wr_terrain_terraces, true),
    { .family = NULL },
};
