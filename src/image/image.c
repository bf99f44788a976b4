/* Images in memory, and the labels of image files. */
#include "image/image.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/memory.h"
#include "base/text.h"
#include "image/read_internal.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* ---- images in memory ---- */

WrImage *wr_image_new(int width, int height, int channels, WrError *err)
{
    if (width < 1 || width > WR_IMAGE_MAX || height < 1 || height > WR_IMAGE_MAX) {
        wr_fail(err, "picture of %dx%d: each side must be 1..%d", width, height, WR_IMAGE_MAX);
        return NULL;
    }
    if (channels < 1 || channels > 4) {
        wr_fail(err, "picture of %d channels: must be 1..4", channels);
        return NULL;
    }
    size_t count = (size_t)width * (size_t)height * (size_t)channels;
    float *data = wr_try_alloc(count, sizeof *data, "a picture", err);
    if (!data) return NULL;
    WrImage *image = wr_alloc(1, sizeof *image);
    *image = (WrImage){ .refs = 1,
                        .width = width,
                        .height = height,
                        .channels = channels,
                        .type = WR_PIXEL_F32,
                        .data = data };
    return image;
}

WrImage *wr_image_share(const WrImage *image)
{
    WrImage *shared = (WrImage *)image; /* only the reference count changes, atomically */
    if (shared) __atomic_fetch_add(&shared->refs, 1, __ATOMIC_RELAXED);
    return shared;
}

void wr_image_free(WrImage *image)
{
    if (!image || __atomic_sub_fetch(&image->refs, 1, __ATOMIC_ACQ_REL) > 0) return;
    wr_free(image->data);
    wr_free(image);
}

/* IEC 61966-2-1. Uses wr_pow, not libm's, so that images are the same on every processor. */
float wr_srgb_encode(float linear)
{
    double x = linear;
    return (float)(x <= 0.0031308 ? 12.92 * x : 1.055 * wr_pow(x, 1.0 / 2.4) - 0.055);
}

float wr_srgb_decode(float code)
{
    double x = code;
    return (float)(x <= 0.04045 ? x / 12.92 : wr_pow((x + 0.055) / 1.055, 2.4));
}

/* Rec. 709 weights, on linear values or on codes, as the picture holds them. */
float wr_image_luma(const float *pixel, int channels)
{
    if (channels < 3) return pixel[0];
    return (float)(0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]);
}

static int64_t finite_floats(const float *in, size_t count, float *out)
{
    int64_t replaced = 0;
    for (size_t i = 0; i < count; i++) {
        bool good = isfinite(in[i]);
        out[i] = good ? in[i] : 0.0f;
        replaced += !good;
    }
    return replaced;
}

int64_t wr_image_codes(WrPixelType type, const float *in, size_t count, void *out, int64_t *clipped)
{
    int64_t replaced = 0, outside = 0;
    if (type == WR_PIXEL_F32) {
        replaced = finite_floats(in, count, out);
    } else {
        double last = wr_pixel_type_max(type);
        for (size_t i = 0; i < count; i++) {
            double x = in[i];
            replaced += !isfinite(x);
            if (!isfinite(x)) x = 0.0;
            outside += x < 0.0 || x > 1.0;
            x = x < 0.0 ? 0.0 : x > 1.0 ? 1.0 : x;
            unsigned code = (unsigned)floor(last * x + 0.5); /* 24 + 16 bits: the sum is exact */
            if (type == WR_PIXEL_U8) ((uint8_t *)out)[i] = (uint8_t)code;
            else ((uint16_t *)out)[i] = (uint16_t)code;
        }
    }
    if (clipped) *clipped = outside;
    return replaced;
}

/* ---- labels of image files ---- */

/* Reads the label of this program's exports (export/export.h). The file is untrusted: invalid values
   are reported and ignored. */

typedef struct Source {
    WrLabelText *text;
    const void *from;
} Source;

static const char *text_of(const Source *from, const char *name)
{
    return from->text(from->from, name);
}

static bool number(const char *text, double *value)
{
    return wr_number_parse(text, strlen(text), value) && fabs(*value) <= FLT_MAX;
}

/* "A,B", both within a float's range. */
static bool pair(const char *text, double *a, double *b)
{
    const char *comma = strchr(text, ',');
    return comma && wr_number_parse(text, (size_t)(comma - text), a) && number(comma + 1, b) &&
           fabs(*a) <= FLT_MAX;
}

static void refuse(WrImageLabel *label, const char *name, const char *text)
{
    if (label->refused[0]) return;
    snprintf(label->refused, sizeof label->refused, "%s=%.60s", name, text);
    for (char *c = label->refused; *c; c++)
        if ((unsigned char)*c < ' ' || *c == 0x7f) *c = '?';
}

static void read_range(const Source *from, double last, WrImageLabel *label)
{
    const char *range = text_of(from, "wrinkle:range");
    if (!range) return;
    double low, high, zero, amplitude;
    if (!pair(range, &low, &high) || !(low < high)) {
        refuse(label, "wrinkle:range", range);
        return;
    }
    label->ranged = true;
    label->low = low;
    label->step = (high - low) / last;
    label->zero = 0;
    /* If 0 has an exact code, heights are relative to it, so that 0 is restored exactly. */
    const char *text = text_of(from, "wrinkle:amplitude");
    if (!text) return;
    const char *code = text_of(from, "wrinkle:zero");
    if (!code || !number(text, &amplitude) || !number(code, &zero) || amplitude < 0 ||
        zero != floor(zero) || zero < 2 || zero > last) {
        label->ranged = false;
        refuse(label, "wrinkle:amplitude", text);
        return;
    }
    label->low = 0;
    label->zero = (int)zero;
    label->step = amplitude / (zero - 1);
}

/* The cell and the height of F = 1; false if invalid. In scene units the height is only the bump height
 * of the exporting scene; only slopes need a valid one. */
static bool read_cell(const Source *from, bool slopes, WrImageLabel *label)
{
    const char *cell = text_of(from, "wrinkle:cell");
    const char *height = text_of(from, "wrinkle:height");
    bool good = true;
    label->cell[0] = label->cell[1] = label->height = 1;
    if (cell && (!pair(cell, &label->cell[0], &label->cell[1]) || !(label->cell[0] >= 1e-9) ||
                 !(label->cell[1] >= 1e-9) || label->cell[0] > 1e9 || label->cell[1] > 1e9)) {
        refuse(label, "wrinkle:cell", cell);
        label->cell[0] = label->cell[1] = 1;
        good = false;
    }
    if (height && (slopes || label->mm) &&
        (!number(height, &label->height) || !(fabs(label->height) <= 1e9) ||
         fabs(label->height) < 1e-9 || (label->mm && label->height < 0))) {
        refuse(label, "wrinkle:height", height);
        label->height = 1;
        good = false;
    }
    return good && cell && height;
}

static void read_size(const Source *from, bool slopes, WrImageLabel *label)
{
    const char *unit = text_of(from, "wrinkle:unit");
    label->mm = unit && strcmp(unit, "mm") == 0;
    const bool known = unit && (label->mm || strcmp(unit, "scene") == 0);
    if (unit && !known) refuse(label, "wrinkle:unit", unit);
    if (!slopes && !known) return;
    label->sized = read_cell(from, slopes, label) && known;
}

static void read_wrap(const Source *from, WrImageLabel *label)
{
    static const char *const words[] = { "periodic", "clamp-u", "clamp-v", "clamp" };
    const char *word = text_of(from, "wrinkle:wrap");
    if (!word) return;
    for (int i = 0; i < 4; i++) {
        if (strcmp(word, words[i]) != 0) continue;
        label->wrapped = true;
        label->clamp[0] = i & 1, label->clamp[1] = i >> 1;
    }
    if (!label->wrapped) refuse(label, "wrinkle:wrap", word);
}

static void read_bump_slopes(const Source *from, WrImageLabel *label)
{
    const char *signs = text_of(from, "wrinkle:signs"), *k = text_of(from, "wrinkle:uvslopes");
    label->turned = signs && strcmp(signs, "renderman") == 0;
    if (k && (!number(k, &label->uvslopes) || !(label->uvslopes >= 0 && label->uvslopes <= 1e9))) {
        refuse(label, "uvslopes_scale", k);
        label->uvslopes = 0;
    }
}

static void read_green(const Source *from, WrImageLabel *label)
{
    const char *word = text_of(from, "wrinkle:convention");
    if (!word) return;
    label->green = strcmp(word, "+Y") == 0 ? 1 : strcmp(word, "-Y") == 0 ? -1 : 0;
    if (!label->green) refuse(label, "wrinkle:convention", word);
}

/* "C2,none" */
static bool read_orders(const char *word, int edge[2])
{
    static const char *const words[] = { "none", "C0", "C1", "C2" };
    const char *comma = strchr(word, ',');
    if (!comma) return false;
    for (int k = 0; k < 2; k++) {
        const char *one = k ? comma + 1 : word;
        const size_t length = k ? strlen(one) : (size_t)(comma - word);
        int i = 0;
        while (i < 4 && (strlen(words[i]) != length || strncmp(words[i], one, length) != 0)) i++;
        if (i == 4) return false;
        edge[k] = i - 1;
    }
    return true;
}

static void read_copies(const Source *from, WrImageLabel *label)
{
    const char *word = text_of(from, "wrinkle:copies");
    double u, v;
    label->copies[0] = label->copies[1] = 1;
    if (!word) return;
    if (pair(word, &u, &v) && u >= 1 && v >= 1 && u <= WR_IMAGE_MAX && v <= WR_IMAGE_MAX &&
        u == floor(u) && v == floor(v))
        label->copies[0] = (int)u, label->copies[1] = (int)v;
    else refuse(label, "wrinkle:copies", word);
}

static void read_edges(const Source *from, WrImageLabel *label)
{
    const char *word = text_of(from, "wrinkle:edges"), *border = text_of(from, "wrinkle:border");
    if (!word) return;
    label->open = strcmp(word, "open,open") == 0;
    label->edged = label->open || read_orders(word, label->edge);
    label->border = border && strcmp(border, "on") == 0;
    if (label->edged) read_copies(from, label);
    else refuse(label, "wrinkle:edges", word);
}

void wr_image_label_read(WrLabelText *text, const void *source, WrPixelType type,
                         WrImageLabel *label)
{
    const Source own = { text, source }, *from = &own;
    *label = (WrImageLabel){ .kind = WR_LABEL_NONE };
    const char *kind = text_of(from, "wrinkle:kind");
    read_bump_slopes(from, label);
    if (!kind) return;
    read_edges(from, label);
    if (strcmp(kind, "height") == 0) {
        label->kind = WR_LABEL_HEIGHT;
        if (type != WR_PIXEL_F32) read_range(from, wr_pixel_type_max(type), label);
    } else if (strcmp(kind, "normal+y") == 0 || strcmp(kind, "normal-y") == 0) {
        label->kind = kind[6] == '+' ? WR_LABEL_NORMAL_UP : WR_LABEL_NORMAL_DOWN;
    } else if (strcmp(kind, "slopes") == 0 || strcmp(kind, "bump-slopes") == 0) {
        label->kind = kind[0] == 'b' ? WR_LABEL_BUMP_SLOPES : WR_LABEL_SLOPES;
    } else if (strcmp(kind, "normal-baked") == 0 || strcmp(kind, "normal-object") == 0) {
        read_green(from, label);
        return;
    } else {
        refuse(label, "wrinkle:kind", kind);
        return;
    }
    if (label->kind >= WR_LABEL_NORMAL_UP && label->kind <= WR_LABEL_NORMAL_DOWN)
        label->green = label->kind == WR_LABEL_NORMAL_UP ? 1 : -1;
    read_size(from, label->kind != WR_LABEL_HEIGHT, label);
    read_wrap(from, label);
}

bool wr_image_apply_range(WrImage *image)
{
    const WrImageLabel *label = &image->label;
    if (!label->ranged || image->type == WR_PIXEL_F32) return false;
    const double last = wr_pixel_type_max(image->type);
    const int channels = image->channels, heights = channels % 2 ? channels : channels - 1;
    const size_t count = (size_t)image->width * (size_t)image->height;
    for (size_t k = 0; k < count; k++)
        for (int c = 0; c < heights; c++) {
            float *value = &image->data[k * (size_t)channels + (size_t)c];
            /* Values are k / last rounded to float: rint restores k exactly, and low + step (k - zero) then has one rounding. */
            const double code = rint((double)*value * last);
            *value = (float)(label->low + label->step * (code - label->zero));
        }
    return true;
}
