/* Contact sheets of a set's maps, or of any kinds. */
#include "export/contact_sheet.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/job.h"
#include "export/preview.h"
#include "image/image.h"
#include "image/caption.h"

#include <math.h>
#include <string.h>

#define GAP 12
#define NAME_H 22
enum { BACKGROUND = 38, INK = 210 }; /* grey values */

struct WrContact {
    const char *path; /* borrowed */
    int tile, columns, width, height;
    int count, done;
    uint8_t *rgb;   /* [height][width][3] */
    WrLabel *label; /* NULL: no font installed */
};

/* ---- sheet ---- */

WrContact *wr_contact_new(const char *path, int count, int tile, WrError *err)
{
    if (!wr_image_can_write(path, WR_PIXEL_U8, 3, false, err)) return NULL;
    WrContact *c = wr_alloc(1, sizeof *c);
    *c = (WrContact){ .path = path, .tile = tile, .columns = 1, .count = count };
    while (c->columns * c->columns < count) c->columns++;
    const int rows = (count + c->columns - 1) / c->columns;
    c->width = GAP + c->columns * (tile + GAP);
    c->height = GAP + rows * (tile + NAME_H + GAP);
    const size_t bytes = 3 * (size_t)c->width * (size_t)c->height;
    c->rgb = wr_try_alloc(bytes, 1, "a contact sheet", err);
    if (!c->rgb) {
        wr_free(c);
        return NULL;
    }
    memset(c->rgb, BACKGROUND, bytes);
    WrError none;
    c->label = wr_label_new(tile < 128 ? 11 : 14, &none);
    return c;
}

void wr_contact_free(WrContact *contact)
{
    if (!contact) return;
    wr_label_free(contact->label);
    wr_free(contact->rgb);
    wr_free(contact);
}

/* Size of the whole sheet, in pixels. */
static void contact_size(const WrContact *contact, int *width, int *height)
{
    *width = contact->width, *height = contact->height;
}

/* Range of texels [from, to) on one axis that pixel i of n covers; the nearest texel if there are fewer texels
   than pixels. Box filter in codes: good enough for a thumbnail, and exact integers on every processor. */
static void span(int i, int n, int texels, int *from, int *to)
{
    *from = (int)((int64_t)i * texels / n);
    *to = (int)((int64_t)(i + 1) * texels / n);
    if (*to <= *from) *to = *from + 1;
}

static void put_pixel(const WrExportPreview *p, const int x[2], const int y[2], uint8_t out[3])
{
    int64_t sum[3] = { 0, 0, 0 };
    const int64_t count = (int64_t)(x[1] - x[0]) * (y[1] - y[0]);
    for (int j = y[0]; j < y[1]; j++)
        for (int i = x[0]; i < x[1]; i++)
            for (int c = 0; c < 3; c++)
                sum[c] += p->rgb[3 * ((size_t)j * (size_t)p->width + (size_t)i) + (size_t)c];
    for (int c = 0; c < 3; c++) out[c] = (uint8_t)((sum[c] + count / 2) / count);
}

/* Length of one side when the longer side fills the tile. */
static int side(int own, int other, int tile)
{
    const int longer = own > other ? own : other;
    const int pixels = (int)lrint((double)tile * own / longer);
    return pixels > 0 ? pixels : 1;
}

/* Text is drawn as a separate grey picture. */
static void put_name(WrContact *c, const char *name, int left, int top)
{
    if (!c->label) return;
    uint8_t *grey = wr_alloc((size_t)c->tile * NAME_H, 1);
    memset(grey, BACKGROUND, (size_t)c->tile * NAME_H);
    wr_label_draw(c->label, name, 1, NAME_H - 6, c->tile - 2, INK, grey, c->tile, NAME_H);
    for (int j = 0; j < NAME_H; j++)
        for (int i = 0; i < 3 * c->tile; i++)
            c->rgb[3 * ((size_t)(top + j) * (size_t)c->width + (size_t)left) + (size_t)i] =
                grey[j * c->tile + i / 3];
    wr_free(grey);
}

void wr_contact_add(WrContact *c, const char *name, const WrExportPreview *picture)
{
    const int w = side(picture->width, picture->height, c->tile);
    const int h = side(picture->height, picture->width, c->tile);
    const int left = GAP + c->done % c->columns * (c->tile + GAP);
    const int top = GAP + c->done / c->columns * (c->tile + NAME_H + GAP);
    WR_ASSERT(c->done < c->count);
    c->done++;
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const size_t at = (size_t)(top + j + (c->tile - h) / 2) * (size_t)c->width;
            int x[2], y[2];
            span(i, w, picture->width, &x[0], &x[1]);
            span(j, h, picture->height, &y[0], &y[1]);
            put_pixel(picture, x, y, c->rgb + 3 * (at + (size_t)(left + i + (c->tile - w) / 2)));
        }
    put_name(c, name, left, top + c->tile);
}

bool wr_contact_write(WrContact *c, WrError *err)
{
    return wr_image_write_pixels(c->path, c->width, c->height, 3, WR_PIXEL_U8, false, c->rgb, err);
}

/* ---- export kind ---- */

static bool is_shown(const WrExportKind *kind)
{
    return !kind->write;
}

/* Kinds of the default: none that needs a mesh, or a surface with the map. */
static bool is_usual(const WrExportKind *kind)
{
    return is_shown(kind) && !kind->on_surface;
}

/* The kind of the next word of "A;B;C"; NULL at the end. */
static const WrExportKind *next_kind(const char **list, char word[40])
{
    if (!**list) return NULL;
    const size_t length = strcspn(*list, ";");
    const int kept = length < 39 ? (int)length : 39;
    memcpy(word, *list, (size_t)kept);
    word[kept] = '\0';
    *list += length + ((*list)[length] == ';');
    return wr_export_find(word);
}

bool wr_export_parse_contact_maps(WrExportOptions *options, const char *value, WrError *err)
{
    char word[40];
    if (!*value) return wr_fail(err, "maps: must be kinds of maps, separated by semicolons");
    for (const char *at = value; *at;) {
        const WrExportKind *kind = next_kind(&at, word);
        if (!kind || !is_shown(kind))
            return wr_fail(err,
                           "maps '%.40s': must be kinds of maps such as height;normal+y, "
                           "separated by semicolons",
                           word);
    }
    options->contact_maps = value;
    return true;
}

bool wr_export_set_contact_tile(WrExportOptions *options, const char *value, WrError *err)
{
    double tile;
    if (!wr_number_parse(value, strlen(value), &tile) || tile != floor(tile) ||
        !(tile >= 32 && tile <= 1024))
        return wr_fail(err, "tile '%.40s': must be whole pixels, 32..1024", value);
    options->contact_tile = (int)tile;
    return true;
}

/* Collects the requested kinds in kinds: [WR_EXPORT_KIND_COUNT * 2]. */
#define KINDS_MAX 64
static int kinds_of(const WrExportOptions *options, const WrExportKind **kinds)
{
    int count = 0;
    char word[40];
    const char *at = options->contact_maps;
    if (!at)
        for (int i = 0; i < WR_EXPORT_KIND_COUNT; i++) {
            if (is_usual(&wr_export_kinds[i])) kinds[count++] = &wr_export_kinds[i];
        }
    else
        while (*at && count < KINDS_MAX) kinds[count++] = next_kind(&at, word);
    return count;
}

bool wr_export_contact_write(WrExportJob *job, const char *path, WrError *err)
{
    const WrExportKind *kinds[KINDS_MAX];
    const int count = kinds_of(&job->options, kinds);
    WrContact *contact = wr_contact_new(path, count, job->options.contact_tile, err);
    bool good = contact != NULL;
    for (int i = 0; i < count && good; i++) {
        WrProgressPart share;
        WrExportPreview picture;
        const WrProgress *whole = wr_progress_enter(&share, (double)i / count, (i + 1.0) / count);
        good = wr_export_preview_like(job, kinds[i], &picture, err) &&
               (!wr_progress_stopped() || wr_fail(err, "cancelled"));
        if (good) wr_contact_add(contact, kinds[i]->name, &picture);
        wr_export_preview_fini(&picture);
        wr_progress_set(whole);
    }
    if (good) {
        contact_size(contact, &job->report.width, &job->report.height);
        job->report.lines = 1;
        good = wr_contact_write(contact, err);
    }
    wr_contact_free(contact);
    return good;
}
