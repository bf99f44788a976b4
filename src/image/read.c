/* Reading of image files: the choice of channels, rows of open files, whole images. */
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "image/codec.h"
#include "image/decode.h"
#include "image/fill_missing.h"
#include "image/image.h"
#include "image/read_internal.h"
#include "image/reader_client.h"
#include "image/sidecar.h"
#include "system/fd.h"
#include "system/process.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

/* The rows of an open file, owned by the result, on failure too; read.c. */
static WrImageRows *image_rows_take(WrImageFile *file, const WrImageRequest *wish, WrError *err);

typedef struct WrError WrError;
typedef struct WrImagePart WrImagePart;
typedef struct WrText WrText;

typedef struct WrChannelChoice {
    int count;    /* 1..4 */
    int index[4]; /* of the part's channels */
} WrChannelChoice;

/* ---- choice of channels ---- */

/* Length of the layer name: 7 for "diffuse.R", whose own name is "R". */
static int layer_length(const char *name)
{
    const char *dot = strrchr(name, '.');
    return dot ? (int)(dot - name) : 0;
}

static const char *own_name(const char *name)
{
    const int length = layer_length(name);
    return length > 0 ? name + length + 1 : name;
}

/* The channel with that layer (`length` letters of `layer`) and own name, or -1. */
static int find_in_layer(const WrImagePart *part, const char *layer, int length, const char *own)
{
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (layer_length(name) == length && strncmp(name, layer, (size_t)length) == 0 &&
            wr_text_same_letters(own_name(name), own))
            return c;
    }
    return -1;
}

/* R, G, B, A of a layer; X, Y, Z, which is one vector (Blender's normals and positions); or Y, A. */
static bool take_layer(const WrImagePart *part, const char *layer, int length, WrChannelChoice *out)
{
    static const char *const sets[3][4] = { { "R", "G", "B", NULL },
                                            { "X", "Y", "Z", NULL },
                                            { "Y", NULL } };
    for (int set = 0; set < 3; set++) {
        WrChannelChoice choice = { 0 };
        bool all = true;
        for (int k = 0; sets[set][k] && all; k++) {
            const int c = find_in_layer(part, layer, length, sets[set][k]);
            all = c >= 0;
            choice.index[choice.count++] = c;
        }
        if (!all) continue;
        const int alpha = find_in_layer(part, layer, length, "A");
        if (alpha >= 0) choice.index[choice.count++] = alpha;
        *out = choice;
        return true;
    }
    return false;
}

/* True for the channel names of formats without names: then the first channels are the image. */
static bool nameless(const WrImagePart *part)
{
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (strchr(name, '.') || wr_text_same_letters(name, "z") ||
            wr_text_same_letters(name, "depth"))
            return false;
    }
    return part->channels <= 4;
}

static void choose_first(const WrImagePart *part, WrChannelChoice *choice)
{
    *choice = (WrChannelChoice){ .count = 1 };
    if (nameless(part)) {
        choice->count = part->channels;
        for (int c = 0; c < part->channels; c++) choice->index[c] = c;
        return;
    }
    if (take_layer(part, "", 0, choice)) return;
    for (int c = 0; c < part->channels; c++) {
        const char *name = part->channel_names[c];
        if (take_layer(part, name, layer_length(name), choice)) return;
    }
}

static void list(const WrImagePart *part, WrText *text)
{
    enum { MAX_MOST = 24 };
    for (int c = 0; c < part->channels && c < MAX_MOST; c++)
        wr_text_addf(text, "%s%.40s", c ? ", " : "", part->channel_names[c]);
    if (part->channels > MAX_MOST) wr_text_addf(text, " and %d more", part->channels - MAX_MOST);
}

/* "a,b", each by its full name. */
static bool take_several(const WrImagePart *part, const char *names, WrChannelChoice *out)
{
    WrChannelChoice choice = { 0 };
    for (const char *at = names; *at;) {
        const size_t length = strcspn(at, ",");
        int c = 0;
        while (c < part->channels &&
               (strncmp(part->channel_names[c], at, length) != 0 || part->channel_names[c][length]))
            c++;
        if (c == part->channels || choice.count == 4) return false;
        choice.index[choice.count++] = c;
        at += length + (at[length] == ',');
    }
    *out = choice;
    return true;
}

/* channel: a channel's name ("Depth.Z") or a layer's ("diffuse": its R, G, B, A or its Y); NULL or "":
 * the first layer with colours or grey, else the first channel. Errors: not found; the message lists
 * the existing ones. */
static bool channels_choose(const WrImagePart *part, const char *channel, WrChannelChoice *choice,
                            WrError *err)
{
    if (!channel || !*channel) {
        choose_first(part, choice);
        return true;
    }
    for (int c = 0; c < part->channels; c++)
        if (strcmp(part->channel_names[c], channel) == 0) {
            *choice = (WrChannelChoice){ .count = 1, .index = { c } };
            return true;
        }
    if (take_layer(part, channel, (int)strlen(channel), choice)) return true;
    if (strchr(channel, ',') && take_several(part, channel, choice)) return true;
    WrText names = { 0 };
    list(part, &names);
    wr_fail(err, "no channel '%.60s': there are %.140s", channel, wr_text_get(&names));
    wr_text_fini(&names);
    return false;
}

/* Appends "diffuse.R, diffuse.G, diffuse.B of Z, diffuse.R, ..."; nothing if all channels are used. */
static void channels_report(const WrImagePart *part, const WrChannelChoice *choice, WrText *text)
{
    if (choice->count == part->channels) return;
    for (int k = 0; k < choice->count; k++)
        wr_text_addf(text, "%s%.40s", k ? ", " : "", part->channel_names[choice->index[k]]);
    wr_text_add(text, " of its channels ");
    list(part, text);
}

/* ---- open files ---- */

/* Untrusted files are read by the reader process; inside this one only if the environment requests it. */
struct WrImageFile {
    WrReader *reader; /* NULL: `decoder` is used */
    WrDecoder *decoder;
    char *path; /* for messages */
    int fd;     /* the decoder's file; -1: the reader has its own */
};

void wr_image_warm(void)
{
    if (!wr_reader_inside()) wr_process_start(NULL);
}

/* Owns the descriptor; -1 means an earlier failure. */
static WrImageFile *open_file(const char *name, int fd, int most, bool numbers, bool outside,
                              WrError *err)
{
    if (fd < 0) return NULL;
    WrImageFile file = { .fd = -1 };
    if (!outside) {
        char ending[16];
        file.decoder = wr_decoder_open(fd, wr_path_ending(name, ending), most, numbers, NULL, err);
        if (file.decoder) file.fd = fd;
        else wr_error_prefix(err, "%s: ", name);
    } else {
        file.reader = wr_reader_open(name, fd, most, numbers, err);
    }
    if (file.fd < 0) wr_fd_close(fd);
    if (!file.reader && !file.decoder) return NULL;
    file.path = wr_strdup(name);
    WrImageFile *opened = wr_alloc(1, sizeof *opened);
    *opened = file;
    return opened;
}

WrImageFile *wr_image_file_open(const char *path, WrError *err)
{
    return open_file(path, wr_reader_file(path, WR_FILE_MAX, err), WR_IMAGE_PARTS_MAX, false,
                     !wr_reader_inside(), err);
}

WrImageFile *wr_image_file_open_levels(const char *path, WrError *err)
{
    return open_file(path, wr_reader_file(path, WR_FILE_MAX, err), WR_CODEC_LEVELS, false,
                     !wr_reader_inside(), err);
}

/* The program's own file: if no reader process or no sandbox is available, it is read in this process. */
WrImageFile *wr_image_file_take(const char *name, int fd, bool levels, WrError *err)
{
    bool outside = !wr_reader_inside() && wr_process_has_cage() && wr_process_start(NULL);
    return open_file(name, fd, levels ? WR_CODEC_LEVELS : WR_IMAGE_PARTS_MAX, false, outside, err);
}

void wr_image_file_close(WrImageFile *file)
{
    if (!file) return;
    wr_reader_close(file->reader);
    wr_decoder_close(file->decoder);
    if (file->fd >= 0) wr_fd_close(file->fd);
    wr_free(file->path);
    wr_free(file);
}

int wr_image_file_parts(const WrImageFile *file)
{
    return file->reader ? wr_reader_parts(file->reader) : wr_decoder_parts(file->decoder);
}

WrImagePart wr_image_file_part(const WrImageFile *file, int part)
{
    return file->reader ? wr_reader_part(file->reader, part) : wr_decoder_part(file->decoder, part);
}

const char *wr_image_file_attribute(const WrImageFile *file, int part, const char *name)
{
    return file->reader ? wr_reader_attribute(file->reader, part, name)
                        : wr_decoder_attribute(file->decoder, part, name);
}

static bool read_rows(WrImageFile *file, int part, int y, int rows, int channels, float *out,
                      WrError *err)
{
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (file->reader) return wr_reader_read(file->reader, part, y, rows, channels, out, err);
    if (wr_decoder_read(file->decoder, part, y, rows, channels, out, NULL, err)) return true;
    wr_error_prefix(err, "%s: ", file->path);
    return false;
}

bool wr_image_file_read_rows(WrImageFile *file, int part, int y, int rows, float *out, WrError *err)
{
    return read_rows(file, part, y, rows, wr_image_file_part(file, part).channels, out, err);
}

bool wr_image_file_read(WrImageFile *file, int part, float *out, WrError *err)
{
    WrImagePart is = wr_image_file_part(file, part);
    size_t row = (size_t)is.width * (size_t)is.channels;
    for (int y = 0; y < is.height; y += WR_IMAGE_BAND) {
        int rows = is.height - y < WR_IMAGE_BAND ? is.height - y : WR_IMAGE_BAND;
        if (!wr_progress_report((double)y / is.height)) return wr_fail(err, "cancelled");
        if (!wr_image_file_read_rows(file, part, y, rows, out + (size_t)y * row, err)) return false;
    }
    return true;
}

bool wr_image_file_digest(WrImageFile *file, int part, int y, int rows, WrHash *digest,
                          WrError *err)
{
    int channels = wr_image_file_part(file, part).channels;
    if (file->reader) return wr_reader_digest(file->reader, part, y, rows, channels, digest, err);
    return wr_decoder_hash_rows(file->decoder, part, y, rows, channels, digest, NULL, err);
}

/* for messages */
static const char *image_file_path(const WrImageFile *file)
{
    return file->path;
}

/* ---- images ---- */

/* Reads rows and the first `channels` channels of a part. */
static bool image_file_read_first(WrImageFile *file, int part, int y, int rows, int channels,
                                  float *out, WrError *err)
{
    return read_rows(file, part, y, rows, channels, out, err);
}

/* Only the first part is opened, unless more are requested, or the format's parts can be listed safely. */
static int most_parts(const char *name, const WrImageRequest *wish)
{
    char buffer[16];
    const char *ending = wr_path_ending(name, buffer);
    const bool several =
        strcmp(ending, "exr") == 0 || strcmp(ending, "tif") == 0 || strcmp(ending, "tiff") == 0;
    return several || (wish->part && *wish->part) ? WR_IMAGE_PARTS_MAX : 1;
}

static WrImageRows *open_rows(const char *name, int fd, const WrImageRequest *wish, WrError *err)
{
    WrImageFile *file =
        open_file(name, fd, most_parts(name, wish), wish->elevation, !wr_reader_inside(), err);
    return file ? image_rows_take(file, wish, err) : NULL;
}

static WrImage *read_whole(WrImageRows *rows, WrError *err)
{
    WrImage *image = rows ? wr_image_rows_whole(rows, err) : NULL;
    wr_image_rows_close(rows);
    return image;
}

WrImageRows *wr_image_rows_open(const char *path, const WrImageRequest *wish, WrError *err)
{
    if (wr_is_raw_path(path)) return wr_sidecar_rows(path, wish, err);
    return open_rows(path, wr_reader_file(path, WR_FILE_MAX, err), wish, err);
}

WrImage *wr_image_read(const char *path, WrError *err)
{
    const WrImageRequest all = { .channel = NULL };
    return wr_image_read_request(path, &all, err);
}

WrImage *wr_image_read_request(const char *path, const WrImageRequest *wish, WrError *err)
{
    return read_whole(wr_image_rows_open(path, wish, err), err);
}

WrImage *wr_image_read_bytes(const char *name, const void *bytes, size_t length, WrError *err)
{
    const WrImageRequest all = { .channel = NULL };
    if (length == 0) {
        wr_fail(err, "%s: is empty", name);
        return NULL;
    }
    return read_whole(open_rows(name, wr_fd_in_memory(name, bytes, length, err), &all, err), err);
}

/* ---- whole images ---- */

/* Reading images, row by row or whole: one part, selected channels, in the file's orientation. */

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
    return wr_fail(err, "no part '%.60s': it has %d, from 1", wish, count);
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
    if (good && !known) good = wr_fail(err, "contains only no-data values");
    if (good) image->replaced = replace_bad_pixels(image->data, pixels, image->channels, false);
    return good;
}

static void tell(const WrImageFile *file, int index, const WrChannelChoice *choice, WrImage *image)
{
    WrText text = { 0 };
    const WrImagePart part = wr_image_file_part(file, index);
    const int parts = wr_image_file_parts(file);
    channels_report(&part, choice, &text);
    if (parts > 1)
        wr_text_addf(&text, "%spart %d of %d%s%.40s", text.length ? " in " : "", index + 1, parts,
                     *part.name ? ", " : "", part.name);
    snprintf(image->taken, sizeof image->taken, "%s", wr_text_get(&text));
    wr_text_fini(&text);
}

/* Reports an all-zero result if only a part of a file was selected. */
static void report_zero(WrImageRows *rows, int count, const float *values)
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
    /* A band is a multiple of WR_IMAGE_STRIP rows, the unit that formats compress together, within about 16 MB; very wide
       pictures with many channels get fewer rows. */
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
    if (!image_file_read_first(rows->file, rows->part, y, count, rows->first, in, err))
        return false;
    if (rows->all) gather(in, pixels, rows->first, &rows->choice, out);
    if (rows->elevation) mark_missing(out, pixels * (size_t)rows->choice.count);
    rows->head.replaced +=
        replace_bad_pixels(out, pixels, rows->choice.count, rows->keep || rows->fills);
    report_zero(rows, count, out);
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
   * 2..8. Orientations 5 to 8 transpose; of the values, 2, 3, 7, 8 reverse columns of the file and 3, 4, 6, 7 its rows. */
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
    const char *path = image_file_path(rows->file);
    if (err && strncmp(err->text, path, strlen(path)) != 0) wr_error_prefix(err, "%s: ", path);
}

static bool choose(WrImageRows *rows, const WrImageRequest *wish, WrError *err)
{
    if (!find_part(rows->file, wish->part, &rows->part, err)) return false;
    rows->is = wr_image_file_part(rows->file, rows->part);
    if (!channels_choose(&rows->is, wish->channel, &rows->choice, err)) return false;
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

static WrImageRows *image_rows_take(WrImageFile *file, const WrImageRequest *wish, WrError *err)
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
