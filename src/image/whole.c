/* Reading images, row by row or whole: one part, selected channels, in the file's orientation. */
#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/channel_choice.h"
#include "image/fill_missing.h"
#include "image/read_internal.h"
#include "image/image_info.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BAND_BYTES ((size_t)16 << 20)  /* of a band, unless it is one strip */
#define BAND_VALUES ((size_t)16 << 20) /* maximum for a strip of many channels */

struct WrImageRows {
    WrImageFile *file;
    WrImagePart is;
    int part;
    WrChannelChoice choice;
    int first;  /* channels to read: up to the last selected one */
    int turned; /* TIFF and EXIF orientation; 1: unchanged. Others are read whole and rotated */
    bool keep, ranged;
    bool fills; /* NaN marks missing values, filled when all rows are read */
    bool elevation;
    WrImage head;
    float *all;    /* rows of the first channels, if not all of them are selected */
    WrImage *band; /* rows [y, y + its height) */
    int y;
    int zeros; /* rows in which all values are 0 */
};

/* Non-finite values become 0 unless they are kept; returns the number of pixels with one. */
static int64_t replace_bad_pixels(float *values, size_t pixels, int channels, bool keep)
{
    int64_t replaced = 0;
    for (size_t i = 0; i < pixels; i++) {
        bool bad = false;
        for (int c = 0; c < channels; c++) {
            float *value = &values[i * (size_t)channels + (size_t)c];
            if (isfinite(*value)) continue;
            if (!keep) *value = 0.0f;
            bad = true;
        }
        replaced += bad;
    }
    return replaced;
}

/* ---- the part ---- */

/* Finds a part by its number from 1, or by its name. */
static bool find_part(const WrImageFile *file, const char *wish, int *part, WrError *err)
{
    const int count = wr_image_file_parts(file);
    *part = 0;
    if (!wish || !*wish) return true;
    double number;
    if (wr_number_parse(wish, strlen(wish), &number) && number >= 1 && number <= count &&
        number == floor(number)) {
        *part = (int)number - 1;
        return true;
    }
    for (int i = 0; i < count; i++)
        if (strcmp(wr_image_file_part(file, i).name, wish) == 0) {
            *part = i;
            return true;
        }
    return wr_fail(err, "part '%.60s': there is no such; it has %d, from 1", wish, count);
}

/* Values that elevation models write for missing data, besides those declared in the header. */
static void mark_missing(float *values, size_t count)
{
    for (size_t i = 0; i < count; i++)
        if (values[i] == -9999.0f || values[i] == -32768.0f || fabsf(values[i]) > 1e30f)
            values[i] = NAN;
}

/* Fills missing values of each channel from their neighbours. A channel without valid values becomes 0;
   an error if only alpha has valid values. */
static bool fill_image(WrImage *image, WrError *err)
{
    const size_t pixels = (size_t)image->width * (size_t)image->height,
                 each = (size_t)image->channels;
    double *z = wr_try_alloc(pixels, sizeof *z, "a picture's missing values", err);
    const size_t colours = each % 2 ? each : each - 1; /* alpha is the last of 2 or 4 */
    bool good = z != NULL, known = false;
    for (size_t c = 0; good && c < each; c++) {
        for (size_t i = 0; i < pixels; i++) z[i] = (double)image->data[i * each + c];
        const int64_t filled = wr_fill_missing(image->width, image->height, z, err);
        good = filled != -2;
        known |= c < colours && filled >= 0;
        if (filled > 0) image->filled += filled;
        for (size_t i = 0; filled > 0 && i < pixels; i++) image->data[i * each + c] = (float)z[i];
    }
    wr_free(z);
    if (good && !known)
        good = wr_fail(err, "every value is missing (no-data): there is nothing to read");
    if (good) image->replaced = replace_bad_pixels(image->data, pixels, image->channels, false);
    return good;
}

static void tell(const WrImageFile *file, int index, const WrChannelChoice *choice, WrImage *image)
{
    WrText text = { 0 };
    const WrImagePart part = wr_image_file_part(file, index);
    const int parts = wr_image_file_parts(file);
    wr_channels_report(&part, choice, &text);
    if (parts > 1)
        wr_text_addf(&text, "%spart %d of %d%s%.40s", text.length ? " in " : "", index + 1, parts,
                     *part.name ? ", " : "", part.name);
    snprintf(image->taken, sizeof image->taken, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Reports an all-zero result if only a part of a file was selected. */
static void tell_zero(WrImageRows *rows, int count, const float *values)
{
    WrImage *head = &rows->head;
    const size_t most = (size_t)rows->is.width * (size_t)count * (size_t)rows->choice.count;
    bool zero = *head->taken != '\0';
    for (size_t k = 0; zero && k < most; k++) zero = values[k] == 0.0f;
    if (zero) rows->zeros += count;
    if (!zero || rows->zeros < rows->is.height) return;
    const size_t length = strlen(head->taken);
    snprintf(head->taken + length, sizeof head->taken - length, "; all of it is 0");
}

/* ---- the pixels ---- */

/* Copies the selected channels of rows that have `from` channels. */
static void gather(const float *in, size_t pixels, int from, const WrChannelChoice *choice,
                   float *out)
{
    for (size_t i = 0; i < pixels; i++)
        for (int k = 0; k < choice->count; k++)
            out[i * (size_t)choice->count + (size_t)k] =
                in[i * (size_t)from + (size_t)choice->index[k]];
}

static bool need_gathering(const WrImageRows *rows)
{
    bool need = rows->first != rows->choice.count;
    for (int k = 0; k < rows->choice.count; k++) need |= rows->choice.index[k] != k;
    return need;
}

/* Number of rows read at once. */
static int band_rows(const WrImageRows *rows)
{
    const size_t row = (size_t)rows->is.width * (size_t)rows->first;
    size_t most = BAND_BYTES / (row * sizeof(float)) / WR_IMAGE_STRIP * WR_IMAGE_STRIP;
    if (most < WR_IMAGE_STRIP) most = WR_IMAGE_STRIP;
    if (most > WR_IMAGE_BAND) most = WR_IMAGE_BAND;
    if (most > BAND_VALUES / row) most = BAND_VALUES / row;
    if (most < 1) most = 1;
    return most < (size_t)rows->is.height ? (int)most : rows->is.height;
}

/* Reads rows [y, y + count) of the part, at most a band: the selected channels. */
static bool read_band(WrImageRows *rows, int y, int count, float *out, WrError *err)
{
    const size_t width = (size_t)rows->is.width, pixels = width * (size_t)count;
    if (!rows->all && need_gathering(rows)) {
        rows->all = wr_try_alloc((size_t)band_rows(rows) * width * (size_t)rows->first,
                                 sizeof *rows->all, "a picture's channels", err);
        if (!rows->all) return false;
    }
    float *in = rows->all ? rows->all : out;
    if (!wr_image_file_read_first(rows->file, rows->part, y, count, rows->first, in, err))
        return false;
    if (rows->all) gather(in, pixels, rows->first, &rows->choice, out);
    if (rows->elevation) mark_missing(out, pixels * (size_t)rows->choice.count);
    rows->head.replaced +=
        replace_bad_pixels(out, pixels, rows->choice.count, rows->keep || rows->fills);
    tell_zero(rows, count, out);
    return true;
}

static bool read_bands(WrImageRows *rows, WrImage *image, WrError *err)
{
    const int most = band_rows(rows);
    const size_t row = (size_t)image->width * (size_t)image->channels;
    bool good = true;
    for (int y = 0; good && y < image->height; y += most) {
        const int left = image->height - y;
        wr_progress_report((double)y / image->height);
        good = read_band(rows, y, left < most ? left : most, image->data + (size_t)y * row, err);
    }
    wr_free(rows->all);
    rows->all = NULL;
    return good;
}

/* ---- orientation ---- */

/* Index in the file's image, w x h, of pixel (x, y) of the image rotated by TIFF and EXIF orientation
 * 2..8. */
static size_t place(int turned, int x, int y, int w, int h)
{
    const bool across = turned == 2 || turned == 3 || turned == 7 || turned == 8;
    const bool down = turned == 3 || turned == 4 || turned == 6 || turned == 7;
    const int a = turned >= 5 ? y : x, b = turned >= 5 ? x : y;
    const int i = across ? w - 1 - a : a, j = down ? h - 1 - b : b;
    return (size_t)j * (size_t)w + (size_t)i;
}

static WrImage *turn(WrImage *image, int turned, WrError *err)
{
    const int w = image->width, h = image->height, n = image->channels;
    WrImage *out = wr_image_new(turned >= 5 ? h : w, turned >= 5 ? w : h, n, err);
    if (out) {
        out->type = image->type;
        out->replaced = image->replaced;
        out->label = image->label;
        out->filled = image->filled;
        memcpy(out->note, image->note, sizeof out->note);
        memcpy(out->taken, image->taken, sizeof out->taken);
        for (int y = 0; y < out->height; y++)
            for (int x = 0; x < out->width; x++)
                memcpy(out->data + ((size_t)y * (size_t)out->width + (size_t)x) * (size_t)n,
                       image->data + place(turned, x, y, w, h) * (size_t)n,
                       (size_t)n * sizeof *out->data);
    }
    wr_image_free(image);
    return out;
}

/* Orientation of the part; 1: unchanged. */
static int turned_of(WrImageFile *file, int part)
{
    const char *text = wr_image_file_attribute(file, part, "wrinkle:orientation");
    return text && strlen(text) == 1 && *text >= '2' && *text <= '8' ? *text - '0' : 1;
}

/* ---- rows ---- */

static void name_file(const WrImageRows *rows, WrError *err)
{
    const char *path = wr_image_file_path(rows->file);
    if (err && strncmp(err->text, path, strlen(path)) != 0) wr_error_prefix(err, "%s: ", path);
}

static bool choose(WrImageRows *rows, const WrImageRequest *wish, WrError *err)
{
    if (!find_part(rows->file, wish->part, &rows->part, err)) return false;
    rows->is = wr_image_file_part(rows->file, rows->part);
    if (!wr_channels_choose(&rows->is, wish->channel, &rows->choice, err)) return false;
    for (int k = 0; k < rows->choice.count; k++)
        if (rows->choice.index[k] >= rows->first) rows->first = rows->choice.index[k] + 1;
    return true;
}

typedef struct Part {
    WrImageFile *file;
    int part;
} Part;

static const char *attribute_of(const void *from, const char *name)
{
    const Part *part = from;
    return wr_image_file_attribute(part->file, part->part, name);
}

WrImageRows *wr_image_rows_of(WrImage *image, bool keep)
{
    WrImageRows *rows = wr_alloc(1, sizeof *rows);
    const size_t pixels = (size_t)image->width * (size_t)image->height;
    image->replaced = replace_bad_pixels(image->data, pixels, image->channels, keep);
    *rows = (WrImageRows){ .keep = keep, .turned = 1, .band = image, .head = *image };
    rows->head.data = NULL;
    return rows;
}

WrImageRows *wr_image_rows_take(WrImageFile *file, const WrImageRequest *wish, WrError *err)
{
    WrImageRows *rows = wr_alloc(1, sizeof *rows);
    *rows = (WrImageRows){ .file = file, .keep = wish->keep_lost };
    if (!choose(rows, wish, err)) {
        name_file(rows, err);
        wr_image_rows_close(rows);
        return NULL;
    }
    rows->turned = turned_of(file, rows->part);
    const bool across = rows->turned >= 5;
    rows->head = (WrImage){ .width = across ? rows->is.height : rows->is.width,
                            .height = across ? rows->is.width : rows->is.height,
                            .channels = rows->choice.count,
                            .type = rows->is.type };
    const Part of = { file, rows->part };
    wr_image_label_read(attribute_of, &of, rows->is.type, &rows->head.label);
    rows->elevation = wish->elevation && !rows->keep && rows->is.type == WR_PIXEL_F32;
    rows->fills = !rows->keep &&
                  (rows->elevation || wr_image_file_attribute(file, rows->part, "wrinkle:no-data"));
    const char *note = wr_image_file_attribute(file, rows->part, "wrinkle:note");
    snprintf(rows->head.note, sizeof rows->head.note, "%s", note ? note : "");
    tell(file, rows->part, &rows->choice, &rows->head);
    return rows;
}

void wr_image_rows_close(WrImageRows *rows)
{
    if (!rows) return;
    wr_image_file_close(rows->file);
    if (rows->band) wr_image_free(rows->band);
    wr_free(rows->all);
    wr_free(rows);
}

const WrImage *wr_image_rows_head(const WrImageRows *rows)
{
    return &rows->head;
}

bool wr_image_rows_apply_range(WrImageRows *rows)
{
    rows->ranged = rows->head.label.ranged && rows->head.type != WR_PIXEL_F32;
    if (rows->ranged && !rows->file) wr_image_apply_range(rows->band); /* all rows are read */
    return rows->ranged;
}

/* An image for rows in the file's orientation, with its properties. */
static WrImage *new_image(const WrImageRows *rows, int height, WrError *err)
{
    WrImage *image = wr_image_new(rows->is.width, height, rows->choice.count, err);
    if (!image) return NULL;
    image->type = rows->head.type;
    image->label = rows->head.label;
    return image;
}

WrImage *wr_image_rows_whole(WrImageRows *rows, WrError *err)
{
    if (!rows->file) return wr_image_share(rows->band);
    WrImage *image = new_image(rows, rows->is.height, err);
    if (image && !read_bands(rows, image, err)) {
        wr_image_free(image);
        image = NULL;
    }
    if (image) {
        image->replaced = rows->head.replaced;
        memcpy(image->note, rows->head.note, sizeof image->note);
        memcpy(image->taken, rows->head.taken, sizeof image->taken);
        if (rows->fills && !fill_image(image, err)) {
            wr_image_free(image);
            image = NULL;
        }
        if (image) rows->head.replaced = image->replaced, rows->head.filled = image->filled;
        if (image && rows->turned > 1) image = turn(image, rows->turned, err);
    }
    if (!image) name_file(rows, err);
    else if (rows->ranged) wr_image_apply_range(image);
    return image;
}

/* The first band: empty; or the whole image, if it is rotated or filled. */
static WrImage *begin_band(WrImageRows *rows, WrError *err)
{
    if (rows->turned > 1 || rows->fills) return wr_image_rows_whole(rows, err);
    WrImage *band = new_image(rows, band_rows(rows), err);
    if (band) band->height = 0;
    else name_file(rows, err);
    return band;
}

static bool next_band(WrImageRows *rows, int y, WrError *err)
{
    WrImage *band = rows->band;
    const int left = rows->is.height - y, most = band_rows(rows);
    const int count = left < most ? left : most;
    band->height = 0;
    if (!read_band(rows, y, count, band->data, err)) {
        name_file(rows, err);
        return false;
    }
    band->height = count;
    rows->y = y;
    if (rows->ranged) wr_image_apply_range(band);
    return true;
}

const float *wr_image_rows_get(WrImageRows *rows, int y, WrError *err)
{
    if (!rows->band) rows->band = begin_band(rows, err);
    const WrImage *band = rows->band;
    if (!band) return NULL;
    if (y >= rows->y + band->height && !next_band(rows, y, err)) return NULL;
    return band->data + (size_t)(y - rows->y) * (size_t)band->width * (size_t)band->channels;
}
