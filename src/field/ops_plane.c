/* Helpers of operations besides the builder: reports, batches, reading with repeated edges, planes. */
#include "field/ops_internal.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/progress.h"
#include "field/field.h"

#include <string.h>

#define ROWS 64 /* of a plane, between two checks for cancellation */

bool wr_op_step(const WrOpJob *job, double fraction)
{
    if (wr_progress_step(job->progress, job->from + (job->to - job->from) * fraction)) return true;
    return wr_fail(job->err, "%s: cancelled", job->name);
}

typedef struct Batch {
    WrPiece piece;
    void *ctx;
    const WrProgress *progress;
    int first;
} Batch;

static void run_piece(int index, int worker, void *ctx)
{
    const Batch *batch = ctx;
    if (!wr_progress_cancelled(batch->progress))
        batch->piece(batch->first + index, worker, batch->ctx);
}

bool wr_op_pieces(const WrOpJob *job, int count, WrPiece piece, void *ctx)
{
    enum { PIECES = 64 };
    Batch batch = { piece, ctx, job->progress, 0 };
    if (!wr_op_step(job, 0.0)) return false;
    for (int first = 0; first < count; first += PIECES) {
        int pieces = count - first < PIECES ? count - first : PIECES;
        batch.first = first;
        wr_pool_run(job->pool, pieces, run_piece, &batch);
        if (!wr_op_step(job, (double)(first + pieces) / count)) return false;
    }
    return true;
}

/* Indices from .. from + count - 1 of an axis of n texels: the range to read, and the output position
   of its first texel; the rest repeats the ends. */
typedef struct Span {
    int from, count, at;
} Span;

static int clamp_index(int i, int low, int high)
{
    return i < low ? low : i > high ? high : i;
}

static Span span_inside(int from, int count, int n, WrWrap wrap)
{
    if (wrap == WR_WRAP_PERIODIC) return (Span){ from, count, 0 };
    int first = clamp_index(from, 0, n - 1), last = clamp_index(from + count - 1, 0, n - 1);
    return (Span){ first, last - first + 1, clamp_index(first - from, 0, count - 1) };
}

void wr_op_read(const WrField *field, int i, int j, int count_i, int count_j, float *out,
                size_t pitch)
{
    Span u = span_inside(i, count_i, wr_field_width(field), wr_field_wrap_u(field));
    Span v = span_inside(j, count_j, wr_field_height(field), wr_field_wrap_v(field));
    wr_field_read(field, u.from, v.from, u.count, v.count, out + (size_t)v.at * pitch + u.at,
                  pitch);
    for (int y = v.at; y < v.at + v.count; y++) {
        float *row = out + (size_t)y * pitch;
        int end = u.at + u.count;
        for (int x = 0; x < u.at; x++) row[x] = row[u.at];
        for (int x = end; x < count_i; x++) row[x] = row[end - 1];
    }
    for (int y = 0; y < count_j; y++) {
        int from = clamp_index(y, v.at, v.at + v.count - 1);
        if (from != y)
            memcpy(out + (size_t)y * pitch, out + (size_t)from * pitch,
                   sizeof *out * (size_t)count_i);
    }
}

bool wr_op_plane_init(WrOpPlane *plane, const WrOpJob *job)
{
    int width = wr_field_width(job->in), height = wr_field_height(job->in);
    size_t pitch = ((size_t)width + 4 + 15) / 16 * 16 + 16;
    if (!wr_op_step(job, 0.0)) return false;
    float *block = wr_try_alloc_unset(pitch * (size_t)height, sizeof *block, job->name, job->err);
    if (!block) return false;
    for (int y = 0; y < height; y++) { /* vector code also computes on the padding between rows */
        /* the system clears each page when it is first written: seconds for the largest tables */
        if (y % ROWS == 0 && wr_progress_cancelled(job->progress)) {
            wr_free(block);
            return wr_fail(job->err, "%s: cancelled", job->name);
        }
        float *row = block + pitch * (size_t)y;
        memset(row, 0, 2 * sizeof *row);
        memset(row + 2 + width, 0, (pitch - 2 - (size_t)width) * sizeof *row);
    }
    *plane = (WrOpPlane){ block, block + 2, pitch, width, height };
    return true;
}

void wr_op_plane_fini(WrOpPlane *plane)
{
    wr_free(plane->block);
    *plane = (WrOpPlane){ 0 };
}
