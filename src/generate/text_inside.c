/* From pieces to the coverage of each texel, row by row, and to the rim. */
#include "generate/text.h"

#include "base/error.h"
#include "base/pool.h"
#include "base/progress.h"
#include "field/field.h"

#include <string.h>

#define ROWS WR_TILE
#define BATCH 16 /* strips of ROWS rows between reports */

typedef struct Work {
    const WrTextShape *shape;
    WrTextPiece *sorted;  /* by row; each row is sorted by column when it is processed */
    const int64_t *first; /* [height + 1] start of each row */
    const WrProgress *progress;
    WrTextInside *out;
    int strip;    /* first of the batch */
    float *cover; /* [BATCH][ROWS][width] */
} Work;

/* ---- sorting ---- */

static int compare(int64_t a, int64_t b)
{
    return (a > b) - (a < b);
}

/* Orders by column, then by content: an order independent of the table's origin. */
static int compare_pieces(const void *a, const void *b)
{
    const WrTextPiece *p = a, *q = b;
    if (p->i != q->i) return p->i < q->i ? -1 : 1;
    if (p->y0 != q->y0) return compare(p->y0, q->y0);
    if (p->x0 != q->x0) return compare(p->x0, q->x0);
    if (p->y1 != q->y1) return compare(p->y1, q->y1);
    return compare(p->x1, q->x1);
}

/* Sorts the shape's pieces by row; *first receives the start of each row. */
static bool sort_rows(WrTextShape *shape, int64_t **first, WrError *err)
{
    size_t height = (size_t)shape->height, count = (size_t)shape->count;
    WrTextPiece *sorted = wr_try_alloc(count + 1, sizeof *sorted, "the outlines of a text", err);
    int64_t *at = sorted ? wr_try_alloc(height + 2, sizeof *at, "the rows of a text", err) : NULL;
    if (!at) {
        wr_free(sorted);
        return false;
    }
    for (size_t k = 0; k < count; k++) at[shape->pieces[k].j + 2]++;
    for (size_t j = 2; j < height + 2; j++) at[j] += at[j - 1];
    for (size_t k = 0; k < count; k++) sorted[at[shape->pieces[k].j + 1]++] = shape->pieces[k];
    wr_free(shape->pieces);
    shape->pieces = sorted;
    shape->room = (int64_t)count + 1;
    *first = at;
    return true;
}

/* ---- rows ---- */

static void fill(float *row, int from, int to, int64_t w)
{
    for (int i = from; i < to && w != 0; i++) row[i] = 1.0f;
}

static void make_row(const Work *work, int j, float *row, struct WrTextRim *rim)
{
    WrTextPiece *p = work->sorted + work->first[j];
    int64_t count = work->first[j + 1] - work->first[j], w = work->shape->base[j];
    int from = 0;
    if (count > 1) qsort(p, (size_t)count, sizeof *p, compare_pieces);
    for (int64_t k = 0; k < count;) {
        int64_t end = k, crossing = 0;
        for (; end < count && p[end].i == p[k].i; end++)
            crossing += (p[end].y0 == 0) - (p[end].y1 == 0);
        bool centre;
        int many = end - k < 1 << 30 ? (int)(end - k) : 1 << 30;
        fill(row, from, p[k].i, w);
        double part = wr_text_texel(p + k, many, w, &centre, rim);
        row[p[k].i] = (float)(centre ? part : -part);
        from = p[k].i + 1;
        w += crossing;
        k = end;
    }
    fill(row, from, work->shape->width, w);
}

static void make_strip(int index, int worker, void *ctx)
{
    (void)worker;
    Work *work = ctx;
    int strip = work->strip + index, width = work->shape->width;
    struct WrTextRim *rim = &work->out->rims[strip];
    float *cover = work->cover + (size_t)index * ROWS * (size_t)width;
    if (wr_progress_cancelled(work->progress)) return;
    memset(cover, 0, (size_t)ROWS * (size_t)width * sizeof *cover);
    for (int y = 0; y < ROWS; y++) {
        rim->first[y] = rim->pieces.count;
        int j = strip * ROWS + y;
        if (j < work->shape->height) make_row(work, j, cover + (size_t)y * (size_t)width, rim);
    }
    rim->first[ROWS] = rim->pieces.count;
}

/* Empty tiles allocate no memory. */
static void keep_strip(const Work *work, int index)
{
    int width = work->shape->width, strip = work->strip + index;
    const float *cover = work->cover + (size_t)index * ROWS * (size_t)width;
    for (int i = 0; i < width; i += WR_TILE) {
        size_t columns = (size_t)(width - i < WR_TILE ? width - i : WR_TILE);
        float *tile = NULL;
        for (int y = 0; y < ROWS; y++) {
            const float *row = cover + (size_t)y * (size_t)width + i;
            for (size_t x = 0; x < columns && !tile; x++)
                if (row[x] != 0.0f)
                    tile = wr_field_tile_write(work->out->cover, i / WR_TILE, strip);
            if (tile) memcpy(tile + y * WR_TILE, row, columns * sizeof *row);
        }
    }
}

static bool run(Work *work, const WrGenerateJob *job, double from, double to)
{
    int strips = (work->shape->height + ROWS - 1) / ROWS;
    for (work->strip = 0; work->strip < strips; work->strip += BATCH) {
        int count = strips - work->strip < BATCH ? strips - work->strip : BATCH;
        if (!wr_progress_step(job->progress, from + (to - from) * work->strip / strips))
            return false;
        wr_pool_run(job->pool, count, make_strip, work);
        if (wr_progress_cancelled(job->progress)) return false;
        for (int k = 0; k < count; k++) keep_strip(work, k);
    }
    return true;
}

void wr_text_inside_fini(WrTextInside *inside, int height)
{
    for (int s = 0; inside->rims && s < (height + ROWS - 1) / ROWS; s++)
        wr_array_free(&inside->rims[s].pieces);
    wr_free(inside->rims);
    wr_field_free(inside->cover);
    *inside = (WrTextInside){ NULL, NULL };
}

bool wr_text_inside(WrTextShape *shape, const WrGenerateJob *job, double from, double to,
                    WrTextInside *out, WrError *err)
{
    WrTextInside inside = { NULL, NULL };
    int64_t *first = NULL;
    Work work = { .shape = shape, .progress = job->progress, .out = &inside };
    size_t strips = (size_t)((shape->height + ROWS - 1) / ROWS), width = (size_t)shape->width;
    size_t batch = strips < BATCH ? strips : BATCH;
    inside.rims = wr_try_alloc(strips, sizeof *inside.rims, "the rim of a text", err);
    bool good = inside.rims && sort_rows(shape, &first, err);
    if (good) {
        inside.cover = wr_field_new(shape->width, shape->height, wr_field_wrap_u(job->like),
                                    wr_field_wrap_v(job->like), 0.0f, err);
        work.cover = wr_try_alloc(batch * ROWS, width * sizeof *work.cover, "a text", err);
        good = inside.cover && work.cover;
    }
    work.sorted = shape->pieces;
    work.first = first;
    if (good && !run(&work, job, from, to)) good = wr_fail(err, "cancelled");
    wr_free(first);
    wr_free(work.cover);
    if (good) *out = inside;
    else wr_text_inside_fini(&inside, shape->height);
    return good;
}
