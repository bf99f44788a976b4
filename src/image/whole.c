/* Whole pictures: one part, some of its channels, the way up that the file tells. */
#include "base/memory.h"
#include "base/progress.h"
#include "image/choose.h"
#include "image/read_inner.h"
#include "image/told.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#define BAND_VALUES ((size_t)16 << 20) /* of a band of many channels, at most */

/* Values that are not finite become 0 unless they are to be kept; returns how many pixels had one. */
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

/* By its number from 1, or by its name. */
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

static void tell(const WrImageFile *file, int index, const WrChannelChoice *choice, WrImage *image)
{
    WrText text = { 0 };
    const WrImagePart part = wr_image_file_part(file, index);
    const int parts = wr_image_file_parts(file);
    wr_channels_tell(&part, choice, &text);
    if (parts > 1)
        wr_text_addf(&text, "%spart %d of %d%s%.40s", text.length ? " in " : "", index + 1, parts,
                     *part.name ? ", " : "", part.name);
    bool zero = text.length > 0;
    const size_t count = (size_t)image->width * (size_t)image->height * (size_t)image->channels;
    for (size_t k = 0; zero && k < count; k++) zero = image->data[k] == 0.0f;
    if (zero) wr_text_add(&text, "; all of it is 0");
    snprintf(image->taken, sizeof image->taken, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* ---- the pixels ---- */

/* Some channels of rows that hold `from` of them; in place where out is in. */
static void gather(const float *in, size_t pixels, int from, const WrChannelChoice *choice,
                   float *out)
{
    for (size_t i = 0; i < pixels; i++)
        for (int k = 0; k < choice->count; k++)
            out[i * (size_t)choice->count + (size_t)k] =
                in[i * (size_t)from + (size_t)choice->index[k]];
}

/* Files give their first channels: as many as reach the last that is wanted. */
static bool read_pixels(WrImageFile *file, int part, const WrChannelChoice *choice, WrImage *image,
                        bool keep, WrError *err)
{
    int first = 0;
    for (int k = 0; k < choice->count; k++)
        if (choice->index[k] >= first) first = choice->index[k] + 1;
    const size_t width = (size_t)image->width, row = width * (size_t)first;
    size_t most = BAND_VALUES / row;
    if (most > WR_IMAGE_BAND) most = WR_IMAGE_BAND;
    if (most < 1) most = 1;
    float *band = wr_try_alloc(most * row, sizeof *band, "a picture's channels", err);
    bool good = band != NULL;
    for (int y = 0; good && y < image->height; y += (int)most) {
        const int left = image->height - y, rows = left < (int)most ? left : (int)most;
        const size_t pixels = width * (size_t)rows;
        float *out = image->data + (size_t)y * width * (size_t)choice->count;
        wr_progress_tell((double)y / image->height);
        good = wr_image_file_read_first(file, part, y, rows, first, band, err);
        if (!good) break;
        gather(band, pixels, first, choice, out);
        image->replaced += replace_bad_pixels(out, pixels, choice->count, keep);
    }
    wr_free(band);
    return good;
}

/* ---- the way up ---- */

/* Where the pixel (x, y) of a picture turned as TIFF and EXIF count (2..8) stands in the file's, w x h. */
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

/* 1: as it is. */
static int turned_of(WrImageFile *file, int part)
{
    const char *text = wr_image_file_attribute(file, part, "wrinkle:orientation");
    return text && strlen(text) == 1 && *text >= '2' && *text <= '8' ? *text - '0' : 1;
}

WrImage *wr_image_file_whole(WrImageFile *file, const WrImageWish *wish, WrError *err)
{
    int index;
    WrChannelChoice choice;
    if (!find_part(file, wish->part, &index, err)) return NULL;
    const WrImagePart part = wr_image_file_part(file, index);
    if (!wr_channels_choose(&part, wish->channel, &choice, err)) return NULL;
    WrImage *image = wr_image_new(part.width, part.height, choice.count, err);
    if (!image) return NULL;
    image->type = part.type;
    wr_image_label_read(file, index, part.type, &image->label);
    if (!read_pixels(file, index, &choice, image, wish->keep_lost, err)) {
        wr_image_free(image);
        return NULL;
    }
    tell(file, index, &choice, image);
    const int turned = turned_of(file, index);
    return turned > 1 ? turn(image, turned, err) : image;
}
