#include "export/atlas.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "export/job.h"
#include "field/field.h"
#include "image/image.h"

#include <math.h>
#include <string.h>

#define CELLS_MOST 256

typedef struct Cells {
    WrField *cell[CELLS_MOST]; /* owned */
    int count, columns;
    int wide, high; /* of a grid place, margins included */
} Cells;

/* ---- the cells ---- */

static WrField *from_document(const char *path, WrError *err)
{
    WrLoaded loaded = { 0 };
    int64_t replaced = 0;
    WrText notes = { 0 };
    const bool good = wr_ora_recognise(path) ? wr_ora_load(path, &loaded, &replaced, &notes, err)
                                             : wr_document_load(path, &loaded, &replaced, err);
    wr_text_fini(&notes);
    if (!good) return NULL;
    const WrField *field = wr_document_whole(loaded.document, NULL, err);
    WrField *own = field ? wr_field_share(field) : NULL;
    wr_document_free(loaded.document);
    wr_loaded_free_images(&loaded);
    wr_free(loaded.scene_text);
    return own;
}

static WrField *from_picture(const char *path, WrError *err)
{
    const WrImageRequest all = { .channel = NULL };
    WrImageRows *rows = wr_image_rows_open(path, &all, err);
    if (!rows) return NULL;
    const WrImageLabel *label = &wr_image_rows_head(rows)->label;
    wr_image_rows_apply_range(rows);
    const WrWrap u = label->wrapped && label->clamp[0] ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
    const WrWrap v = label->wrapped && label->clamp[1] ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC;
    WrField *field = NULL;
    if (label->kind >= WR_LABEL_NORMAL_UP)
        wr_fail(err, "%s: its label tells that it holds no heights, which an atlas is made of",
                path);
    else field = wr_import_rows(rows, 0, 0, u, v, err);
    wr_image_rows_close(rows);
    return field;
}

static WrField *from_file(const char *path, WrError *err)
{
    char ending[16];
    if (wr_document_recognise(path) || wr_ora_recognise(path)) return from_document(path, err);
    if (strcmp(wr_path_ending(path, ending), "wrinkle") != 0) return from_picture(path, err);
    wr_fail(err,
            "%s: a script is no cell of an atlas: must be a document or a picture, as one that "
            "the script saves",
            path);
    return NULL;
}

static bool add_file(Cells *cells, const char *path, WrError *err)
{
    if (cells->count == CELLS_MOST)
        return wr_fail(err, "an atlas takes up to %d cells", CELLS_MOST);
    WrField *field = from_file(path, err);
    if (field) cells->cell[cells->count++] = field;
    return field != NULL;
}

/* Adds the cells of "A;B;C". */
static bool add_files(Cells *cells, const char *list, WrError *err)
{
    for (const char *at = list; *at;) {
        const size_t length = strcspn(at, ";");
        char *path = wr_strndup(at, length);
        const bool good = !length || add_file(cells, path, err);
        wr_free(path);
        if (!good) return false;
        at += length + (at[length] == ';');
    }
    return true;
}

/* ---- the table ---- */

static int within(int i, int n, bool clamp)
{
    if (clamp) return i < 0 ? 0 : i >= n ? n - 1 : i;
    const int rest = i % n;
    return rest < 0 ? rest + n : rest;
}

/* Copies the cell with its margins to (x, y) of the table. */
static void place(WrField *to, const WrField *cell, int x, int y, int margin)
{
    const int w = wr_field_width(cell), h = wr_field_height(cell), width = w + 2 * margin;
    const bool clamp_u = wr_field_wrap_u(cell) == WR_WRAP_CLAMP;
    const bool clamp_v = wr_field_wrap_v(cell) == WR_WRAP_CLAMP;
    float *row = wr_alloc((size_t)w + (size_t)width, sizeof *row), *out = row + w;
    for (int j = -margin; j < h + margin; j++) {
        wr_field_read(cell, 0, within(j, h, clamp_v), w, 1, row, (size_t)w);
        for (int i = 0; i < width; i++) out[i] = row[within(i - margin, w, clamp_u)];
        wr_field_write(to, x, y + j + margin, width, 1, out, (size_t)width);
    }
    wr_free(row);
}

static void tell(WrText *label, const WrField *cell, int x, int y)
{
    wr_text_addf(label, "%s%d,%d,%d,%d", label->length ? ";" : "", x, y, wr_field_width(cell),
                 wr_field_height(cell));
}

static void measure(Cells *cells, int margin)
{
    while (cells->columns * cells->columns < cells->count) cells->columns++;
    for (int k = 0; k < cells->count; k++) {
        const int w = wr_field_width(cells->cell[k]) + 2 * margin;
        const int h = wr_field_height(cells->cell[k]) + 2 * margin;
        cells->wide = w > cells->wide ? w : cells->wide;
        cells->high = h > cells->high ? h : cells->high;
    }
}

static WrField *lay(WrExportJob *job, Cells *cells, WrError *err)
{
    const int margin = job->options.margin;
    measure(cells, margin);
    const int rows = (cells->count + cells->columns - 1) / cells->columns;
    const int64_t width = (int64_t)cells->columns * cells->wide,
                  height = (int64_t)rows * cells->high;
    if (width > WR_FIELD_MAX || height > WR_FIELD_MAX) {
        wr_fail(err, "the atlas has %lldx%lld texels: each side must be 1..%d", (long long)width,
                (long long)height, WR_FIELD_MAX);
        return NULL;
    }
    const WrField *own = cells->cell[0];
    WrField *made = wr_field_new((int)width, (int)height, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, err);
    if (!made) return NULL;
    job->options.cell_w *= (double)width / wr_field_width(own);
    job->options.cell_h *= (double)height / wr_field_height(own);
    WrText *label = wr_export_attribute(job, "wrinkle:atlas");
    for (int k = 0; k < cells->count; k++) {
        const int x = k % cells->columns * cells->wide, y = k / cells->columns * cells->high;
        place(made, cells->cell[k], x, y, margin);
        tell(label, cells->cell[k], x + margin, y + margin);
    }
    return made;
}

WrField *wr_export_atlas(WrExportJob *job, const WrField *own, WrError *err)
{
    Cells cells = { .count = 1, .columns = 1 };
    cells.cell[0] = wr_field_share(own);
    WrField *made = add_files(&cells, job->options.atlas, err) ? lay(job, &cells, err) : NULL;
    for (int k = 0; k < cells.count; k++) wr_field_free(cells.cell[k]);
    return made;
}
