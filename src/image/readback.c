#include "image/readback.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "image/decode.h"
#include "image/exr_chunks.h"
#include "image/image.h"
#include "image/read_internal.h"
#include "system/fd.h"
#include "system/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

/* Opens the same file again, with a position of its own. */
static int open_again(int fd, WrError *err)
{
    int again = wr_fd_again(fd);
    if (again < 0) wr_fail(err, "%s", strerror(errno));
    return again;
}

static bool verify_texts(WrImageFile *file, int index, const WrImageOut *part, WrError *err)
{
    for (int i = 0; i < part->attribute_count; i++) {
        const char *want = part->attributes[i].text;
        const char *have = wr_image_file_attribute(file, index, part->attributes[i].name);
        if (strcmp(have ? have : "", want) != 0)
            return wr_fail(err, "%.80s of part %d is not what was written",
                           part->attributes[i].name, index + 1);
    }
    return true;
}

#define MAX_CHANNELS 64 /* maximum number of channels that may be reordered in the file */

/* EXR sorts channels by their names: channel c of the part is channel from[c] of the file. *moved: the
 * order differs. False if the channels differ. */
static bool find_channels(const WrImageOut *part, const WrImagePart *is, int from[MAX_CHANNELS],
                          bool *moved)
{
    *moved = false;
    if (is->channels != part->channels || part->channels > MAX_CHANNELS) return false;
    for (int c = 0; part->channel_names && c < is->channels; c++) {
        int at = 0;
        while (at < is->channels && strcmp(part->channel_names[c], is->channel_names[at]) != 0)
            at++;
        if (at == is->channels) return false;
        from[c] = at;
        *moved |= at != c;
    }
    return true;
}

/* Reorders values from the file's order to the part's. */
static void put_in_order(const int *from, int channels, size_t texels, const float *values,
                         float *out)
{
    for (size_t i = 0; i < texels; i++)
        for (int c = 0; c < channels; c++)
            out[i * (size_t)channels + (size_t)c] = values[i * (size_t)channels + (size_t)from[c]];
}

/* Rows are transferred in a memory file, two strips at a time at most, to which the file size limit
 * applies too; digests need no file. */
static bool rows_fit(const WrImageOut *part)
{
    const size_t row = (size_t)part->width * (size_t)part->channels * sizeof(float);
    return 2 * (uint64_t)row * WR_IMAGE_STRIP < wr_process_file_limit();
}

/* Passes strips to the digest and to the `seen` callback. from: channel order in the file; NULL: the
 * part's order. */
static bool show_rows(WrImageFile *file, int index, const WrImageOut *part, bool exact,
                      const int *from, WrHash *have, WrError *err)
{
    const size_t row = (size_t)part->width * (size_t)part->channels;
    const size_t strip = row * WR_IMAGE_STRIP;
    float *values =
        wr_try_alloc(from ? 2 * strip : strip, sizeof *values, "rows of a picture", err);
    float *shown = from ? values + strip : values;
    bool good = values != NULL;
    for (int y = 0; y < part->height && good; y += WR_IMAGE_STRIP) {
        int rows = part->height - y < WR_IMAGE_STRIP ? part->height - y : WR_IMAGE_STRIP;
        good = (!wr_progress_stopped() || wr_fail(err, "cancelled")) &&
               wr_image_file_read_rows(file, index, y, rows, values, err);
        if (good) wr_digest_strip(have, values, row * (size_t)rows);
        if (good && from)
            put_in_order(from, part->channels, (size_t)part->width * (size_t)rows, values, shown);
        good = good && part->seen(part->ctx, y, rows, shown, exact, err);
    }
    wr_free(values);
    return good;
}

static bool digest_rows(WrImageFile *file, int index, int height, WrHash *have, WrError *err)
{
    for (int y = 0; y < height; y += WR_IMAGE_BAND) {
        int rows = height - y < WR_IMAGE_BAND ? height - y : WR_IMAGE_BAND;
        if (!wr_image_file_digest(file, index, y, rows, have, err)) return false;
    }
    return true;
}

static bool verify_part(WrImageFile *file, int index, const WrImageFormat *format,
                        const WrImageOut *part, WrHash want, WrError *err)
{
    WrImagePart is = wr_image_file_part(file, index);
    WrHash have = { 0 };
    bool exact = format->exact && !(part->channel_names && part->channels > 1);
    if (is.width != part->width || is.height != part->height)
        return wr_fail(err, "part %d is %dx%d, not %dx%d", index + 1, is.width, is.height,
                       part->width, part->height);
    if (exact && is.channels != part->channels)
        return wr_fail(err, "part %d has %d channels, not %d", index + 1, is.channels,
                       part->channels);
    int from[MAX_CHANNELS];
    bool moved;
    bool shown = part->seen && find_channels(part, &is, from, &moved) && rows_fit(part);
    if (!(shown ? show_rows(file, index, part, format->exact, moved ? from : NULL, &have, err)
                : digest_rows(file, index, is.height, &have, err)))
        return false;
    if (exact && !wr_hash_equal(have, want))
        return wr_fail(err, "texels of part %d are not what was written", index + 1);
    /* Other formats store all texts as lines of one, if at all. */
    return strcmp(format->library, "openexr") != 0 || verify_texts(file, index, part, err);
}

bool wr_image_verify(const char *name, int fd, const WrImageFormat *format, const WrImageOut *parts,
                     int count, const WrHash *digests, WrError *err)
{
    WrError inner = { "" };
    WrImageFile *file = wr_image_file_take(name, open_again(fd, &inner), parts[0].levels, &inner);
    bool good = file != NULL;
    if (good && strcmp(format->library, "openexr") == 0) good = wr_exr_check_chunks(fd, &inner);
    if (good && wr_image_file_parts(file) != count)
        good = wr_fail(&inner, "%d parts, not %d", wr_image_file_parts(file), count);
    for (int i = 0; i < count && good; i++)
        good = verify_part(file, i, format, &parts[i], digests[i], &inner);
    wr_image_file_close(file);
    if (good) return true;
    size_t length = strlen(name);
    bool named = strncmp(inner.text, name, length) == 0 && inner.text[length] == ':';
    return wr_fail(err, "it does not read back as it was written: %s",
                   named ? inner.text + length + 2 : wr_error_message(&inner));
}
