#include "export/cell_layout.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/pool.h"
#include "base/text.h"
#include "document/document.h"
#include "document/document_file.h"
#include "document/ora.h"
#include "export/job.h"
#include "field/field.h"
#include "field/ops.h"
#include "field/scheme.h"
#include "image/image.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

typedef struct WrError WrError;
typedef struct WrExportJob WrExportJob;
typedef struct WrField WrField;

/* ---- atlas ---- */

#define MAX_CELLS 256

typedef struct Cells {
    WrField *cell[MAX_CELLS]; /* owned */
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
        wr_fail(err, "%s: by its metadata it contains no heights; an atlas needs heights", path);
    else field = wr_import_rows(rows, 0, 0, u, v, err);
    wr_image_rows_close(rows);
    return field;
}

static WrField *from_file(const char *path, WrError *err)
{
    char ending[16];
    if (wr_document_recognise(path) || wr_ora_recognise(path)) return from_document(path, err);
    if (strcmp(wr_path_ending(path, ending), "wrinkle") != 0) return from_picture(path, err);
    wr_fail(err, "%s: a script cannot be a cell of an atlas: must be a document or a picture",
            path);
    return NULL;
}

static bool add_file(Cells *cells, const char *path, WrError *err)
{
    if (cells->count == MAX_CELLS) return wr_fail(err, "an atlas holds up to %d cells", MAX_CELLS);
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

/* Copies the cell with its margins to (x, y) of the table. Without margins, a filter near a cell's border would read the
   neighbour in the atlas; for `margin` texels, and so for log2(margin) mip levels, it reads the cell's own continuation. */
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

static WrField *lay_cells(WrExportJob *job, Cells *cells, WrError *err)
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

/* Arranges the job's own table and those of the files named in its options, in this order, row by row in a
   nearly square grid. Their positions go into the job's label "wrinkle:atlas", "x,y,width,height;...". Margins
   repeat the continuation beyond a cell's edges. Errors: a file without heights; more than WR_FIELD_MAX texels;
   no memory. */
static WrField *export_atlas(WrExportJob *job, const WrField *own, WrError *err)
{
    Cells cells = { .count = 1, .columns = 1 };
    cells.cell[0] = wr_field_share(own);
    WrField *made = add_files(&cells, job->options.atlas, err) ? lay_cells(job, &cells, err) : NULL;
    for (int k = 0; k < cells.count; k++) wr_field_free(cells.cell[k]);
    return made;
}

#define SQRT3 1.7320508075688772

/* A table under construction. */
typedef struct Sheet {
    WrExportJob *job;
    WrField *field; /* owned; NULL: the job's own table */
    const WrField *from;
    int width, height; /* size of the new table */
} Sheet;

static const WrField *now(const Sheet *s)
{
    return s->field ? s->field : s->job->field;
}

static void take(Sheet *s, WrField *field)
{
    wr_field_free(s->field);
    s->field = field;
}

/* ---- rows of a new table ---- */

/* Fills row y of the new table from s->from. */
typedef void Row(const Sheet *s, int y, float *out);

static bool make(Sheet *s, int width, int height, Row *row, WrError *err)
{
    const WrField *from = now(s);
    if (width > WR_FIELD_MAX || height > WR_FIELD_MAX)
        return wr_fail(err, "the sheet has %dx%d texels: each side must be 1..%d", width, height,
                       WR_FIELD_MAX);
    WrField *made =
        wr_field_new(width, height, wr_field_wrap_u(from), wr_field_wrap_v(from), 0, err);
    if (!made) return false;
    Sheet own = { s->job, NULL, from, width, height };
    float *line = wr_alloc((size_t)width, sizeof *line);
    for (int y = 0; y < height; y++) {
        row(&own, y, line);
        wr_field_write(made, 0, y, width, 1, line, (size_t)width);
    }
    wr_free(line);
    take(s, made);
    return true;
}

/* Copies columns [i, i + count) of the old table's row j, wrapped even if its edges are clamped. */
static void copy(const WrField *from, int i, int j, int count, float *out)
{
    const int width = wr_field_width(from), height = wr_field_height(from);
    for (int done = 0; done < count;) {
        const int at = (i + done) % width;
        const int run = width - at < count - done ? width - at : count - done;
        wr_field_read(from, at, j % height, run, 1, out + done, (size_t)run);
        done += run;
    }
}

static void repeat_row(const Sheet *s, int y, float *out)
{
    copy(s->from, 0, y, s->width, out);
}

/* Half-drop: two copies side by side, the second moved by half a height; the new cell of 2 w x h tiles plainly. Brick is the
   same with the axes exchanged. */
static void half_drop_row(const Sheet *s, int y, float *out)
{
    const int width = wr_field_width(s->from);
    copy(s->from, 0, y, width, out);
    copy(s->from, 0, y + s->height / 2, width, out + width);
}

static void brick_row(const Sheet *s, int y, float *out)
{
    const bool second = y >= wr_field_height(s->from);
    copy(s->from, second ? s->width / 2 : 0, y, s->width, out);
}

static void formula_row(const Sheet *s, int y, float *out)
{
    wr_export_heights(s->job, y, 1, out);
}

/* The cell's sides are those of the lattice: one along x, the other at 60 degrees to it. A point (x, y) of the
   rectangle of L by sqrt(3) L is at u = x/L - y/(sqrt(3) L), v = 2y/(sqrt(3) L). */
static void hex_row(const Sheet *s, int y, float *out)
{
    const size_t width = (size_t)s->width;
    double *u = wr_alloc(3 * width, sizeof *u), *v = u + width, *f = v + width;
    const double t = 1 - (y + 0.5) / s->height;
    /* In units of the rectangle: x / L = (i + 1/2) / width and y / (sqrt(3) L) = t, hence u = x / L - t and v = 2 t. The
       rectangle holds two rows of the lattice, so its edges meet the lattice's translations L and (0, sqrt(3) L). */
    for (int i = 0; i < s->width; i++) u[i] = (i + 0.5) / s->width - t, v[i] = 2 * t;
    wr_field_sample(s->from, (WrScheme)s->job->options.scheme, width, u, v, f, NULL, NULL);
    for (int i = 0; i < s->width; i++) out[i] = (float)f[i];
    wr_free(u);
}

/* ---- the steps ---- */

static bool is_periodic(const WrField *field)
{
    return wr_field_wrap_u(field) == WR_WRAP_PERIODIC && wr_field_wrap_v(field) == WR_WRAP_PERIODIC;
}

static bool lay_sheet(Sheet *s, WrError *err)
{
    WrExportOptions *o = &s->job->options;
    const int w = wr_field_width(now(s)), h = wr_field_height(now(s));
    if (o->lay == WR_LAY_PLAIN) return true;
    if (!is_periodic(now(s)))
        return wr_fail(err, "lay_cells=%s: the table must be periodic both ways",
                       wr_lay_names[o->lay]);
    switch (o->lay) {
    case WR_LAY_HALF_DROP:
        if (h % 2) return wr_fail(err, "lay_cells=half-drop: %d rows: must be even", h);
        o->cell_w *= 2;
        s->job->copies[0] = 2;
        return make(s, 2 * w, h, half_drop_row, err);
    case WR_LAY_BRICK:
        if (w % 2) return wr_fail(err, "lay_cells=brick: %d columns: must be even", w);
        o->cell_h *= 2;
        s->job->copies[1] = 2;
        return make(s, w, 2 * h, brick_row, err);
    case WR_LAY_HEX:
        o->cell_h = SQRT3 * o->cell_w;
        return make(s, w, (int)lround(SQRT3 * w), hex_row, err);
    case WR_LAY_PLAIN:
    case WR_LAYS: break;
    }
    return true;
}

static bool repeat(Sheet *s, WrError *err)
{
    WrExportOptions *o = &s->job->options;
    const int m = o->repeat_u > 1 ? o->repeat_u : 1, n = o->repeat_v > 1 ? o->repeat_v : 1;
    if (m == 1 && n == 1) return true;
    o->cell_w *= m, o->cell_h *= n;
    s->job->copies[0] = m * (s->job->copies[0] ? s->job->copies[0] : 1);
    s->job->copies[1] = n * (s->job->copies[1] ? s->job->copies[1] : 1);
    return make(s, m * wr_field_width(now(s)), n * wr_field_height(now(s)), repeat_row, err);
}

/* The power of two that is nearest by ratio. n^2 > 2 p^2 means n / p > sqrt(2): the geometric mean of p and 2 p separates
   them. */
static int power_near(int n)
{
    int power = 1;
    while (2 * power <= WR_FIELD_MAX && (double)n * n > 2.0 * power * power) power *= 2;
    return power;
}

static WrField *resized(const WrExportJob *job, const WrField *field, int width, int height,
                        int filter, WrError *err)
{
    const double values[] = { width, height, filter };
    const WrOpOptions options = { .pool = job->pool };
    return wr_op_run(wr_op_find("resize"), field, values, &options, err);
}

static bool resize(Sheet *s, WrError *err)
{
    const WrExportOptions *o = &s->job->options;
    int w = o->resize_w, h = o->resize_h;
    if (w == 0) return true;
    if (w < 0) w = power_near(wr_field_width(now(s))), h = power_near(wr_field_height(now(s)));
    if (w == wr_field_width(now(s)) && h == wr_field_height(now(s))) return true;
    WrField *made = resized(s->job, now(s), w, h, o->filter, err);
    if (made) take(s, made);
    return made != NULL;
}

WrField *wr_export_build_table(WrExportJob *job, bool *good, WrError *err)
{
    const WrExportOptions *o = &job->options;
    if (o->lay == WR_LAY_PLAIN && o->repeat_u <= 1 && o->repeat_v <= 1 && o->resize_w == 0 &&
        !o->atlas && !o->mips)
        return NULL;
    Sheet s = { .job = job };
    /* Order: a formula becomes a table, then the arrangement of cells, repeats, resizing, and the atlas last; each step reads
       the table of the step before. */
    *good = (!job->analytic || make(&s, job->width, job->height, formula_row, err)) &&
            lay_sheet(&s, err) && repeat(&s, err) && resize(&s, err);
    if (*good && o->atlas) {
        WrField *atlas = export_atlas(job, now(&s), err);
        *good = atlas != NULL;
        if (atlas) take(&s, atlas);
    }
    if (*good && !s.field) s.field = wr_field_share(job->field);
    if (*good) return s.field;
    wr_field_free(s.field);
    return NULL;
}

/* If neighbouring cells meet at other rows than their edges, as in an atlas or a hexagonal sheet, the original
   cell is tested. */
WrCertificate wr_export_certify_seam(const WrExportJob *job)
{
    if (job->analytic) return wr_certificate_formula(&job->scene->analytic);
    const WrExportOptions *o = &job->options;
    const WrScheme scheme = o->scheme < 0 ? job->scene->scheme : (WrScheme)o->scheme;
    const WrSeamOptions seam = { .copies = { job->copies[0], job->copies[1] } };
    WrCertificate out = wr_certificate_table(job->field, scheme, &seam);
    if (o->lay == WR_LAY_HEX || o->atlas) out.pattern = wr_seam_measure(job->cell, NULL);
    return out;
}

/* ---- mip levels as files ---- */

WrField *wr_export_half(const WrExportJob *job, const WrField *field, WrError *err)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    return resized(job, field, w > 1 ? w / 2 : 1, h > 1 ? h / 2 : 1, WR_RESIZE_BOX, err);
}

void wr_export_level_name(const char *path, int level, WrText *name)
{
    const char *slash = strrchr(path, '/'), *dot = strrchr(path, '.');
    const size_t stem = dot && (!slash || dot > slash) ? (size_t)(dot - path) : strlen(path);
    wr_text_clear(name);
    wr_text_add_n(name, path, stem);
    wr_text_addf(name, "_%d%s", level, path + stem);
}
