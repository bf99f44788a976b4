/* Filters and compression of PNG rows (PNG specification, sections 9 and 10).

   One zlib stream is the concatenation of its segments: each is compressed on its own, without the text before it, and ends at a
   byte by an empty block (Z_SYNC_FLUSH), except the last one. */
#include "image/png_stream.h"

#include "base/memory.h"
#include "base/pool.h"

#include <string.h>
#include <zlib.h>

#define SEGMENT (1 << 18) /* bytes of rows compressed as one */
#define BATCH 8           /* segments compressed at once */
#define SAMPLE (1 << 15)  /* bytes that select a segment's strategy */
#define LEVEL 4           /* half the time of zlib's default, 6, for files 2 % larger */
#define MARGIN 8          /* zeros before each row: the pixel left of the first */
#define FILTERS 5
#define HEAD 2 /* bytes of the zlib stream before the first segment, */
#define TAIL 4 /* and after the last */

typedef struct Segment {
    uint8_t *text;   /* filtered rows, each after its filter's number */
    uint8_t *packed; /* HEAD free bytes, compressed text, TAIL free bytes */
    size_t length;   /* of the text */
    size_t count;    /* of compressed bytes; 0: out of memory, or cancelled */
    uint32_t adler;  /* of the text */
    int first, rows; /* rows of the batch */
} Segment;

struct WrPngStream {
    size_t row, pitch;
    int pixel, height;
    bool swaps;
    WrPool *pool;
    int done, held;     /* rows before the batch, and in it */
    int most, per;      /* rows of a batch, and of a segment */
    uint8_t *rows;      /* [1 + most][pitch]: the row above the batch first */
    uint8_t *candidate; /* [BATCH][FILTERS][row] */
    Segment segment[BATCH];
    uint32_t adler; /* of all text so far */
};

/* ---- filters ---- */

/* Paeth's predictor: of left, up and upper left the one nearest to left + up - upper left. */
static void filter_paeth(const uint8_t *restrict a, const uint8_t *restrict up, size_t pixel,
                         size_t row, uint8_t *restrict out)
{
    const uint8_t *restrict before = a - pixel, *restrict corner = up - pixel;
#pragma omp simd
    for (size_t i = 0; i < row; i++) {
        const int16_t l = before[i], u = up[i], c = corner[i];
        const int16_t x = (int16_t)(u - c), y = (int16_t)(l - c), z = (int16_t)(x + y);
        const int16_t to_l = x < 0 ? (int16_t)-x : x, to_u = y < 0 ? (int16_t)-y : y,
                      to_c = z < 0 ? (int16_t)-z : z;
        const int16_t rest = to_u <= to_c ? u : c;
        const int16_t guess = ((to_l <= to_u) & (to_l <= to_c)) ? l : rest;
        out[i] = (uint8_t)(a[i] - guess);
    }
}

/* All filters of a row, in the order of their numbers: none, left, up, mean, Paeth. */
static void filter_all(const uint8_t *restrict a, const uint8_t *restrict up, size_t pixel,
                       size_t row, uint8_t *restrict out)
{
    const uint8_t *restrict before = a - pixel;
    uint8_t *restrict left = out + row, *restrict above = out + 2 * row,
                      *restrict mean = out + 3 * row;
    memcpy(out, a, row);
#pragma omp simd
    for (size_t i = 0; i < row; i++) {
        left[i] = (uint8_t)(a[i] - before[i]);
        above[i] = (uint8_t)(a[i] - up[i]);
        mean[i] = (uint8_t)(a[i] - (uint8_t)((before[i] + up[i]) >> 1));
    }
    filter_paeth(a, up, pixel, row, out + 4 * row);
}

/* The specification's measure: sum of the absolute values of the bytes as signed numbers. */
static uint64_t weight(const uint8_t *bytes, size_t count)
{
    uint64_t sum = 0;
    for (size_t from = 0; from < count; from += 4096) {
        const size_t end = count - from < 4096 ? count : from + 4096;
        uint32_t part = 0;
#pragma omp simd reduction(+ : part)
        for (size_t i = from; i < end; i++)
            part += bytes[i] < 128 ? bytes[i] : (uint8_t)(256 - bytes[i]);
        sum += part;
    }
    return sum;
}

static void filter_row(const WrPngStream *s, const uint8_t *row, uint8_t *candidate, uint8_t *text)
{
    int best = 0;
    uint64_t least = UINT64_MAX;
    filter_all(row, row - s->pitch, (size_t)s->pixel, s->row, candidate);
    for (int f = 0; f < FILTERS; f++) {
        const uint64_t heavy = weight(candidate + (size_t)f * s->row, s->row);
        if (heavy < least) least = heavy, best = f;
    }
    text[0] = (uint8_t)best;
    memcpy(text + 1, candidate + (size_t)best * s->row, s->row);
}

/* ---- compression ---- */

/* Bytes of the compressed text; 0: out of memory. */
static size_t deflate_text(const uint8_t *text, size_t length, int strategy, int flush,
                           uint8_t *out, size_t room)
{
    z_stream z = { 0 };
    if (deflateInit2(&z, LEVEL, Z_DEFLATED, -15, 8, strategy) != Z_OK) return 0;
    z.next_in = (Bytef *)text;
    z.avail_in = (uInt)length;
    z.next_out = out;
    z.avail_out = (uInt)room;
    deflate(&z, flush);
    deflateEnd(&z);
    return room - z.avail_out;
}

static size_t room_of(size_t length)
{
    return compressBound((uLong)length) + 64;
}

static void pack(int index, int worker, void *ctx)
{
    WrPngStream *s = ctx;
    Segment *g = &s->segment[index];
    (void)worker;
    for (int j = 0; j < g->rows; j++)
        filter_row(s, s->rows + (size_t)(1 + g->first + j) * s->pitch + MARGIN,
                   s->candidate + (size_t)index * FILTERS * s->row,
                   g->text + (size_t)j * (s->row + 1));
    const size_t room = room_of(g->length), some = g->length < SAMPLE ? g->length : SAMPLE;
    uint8_t *out = g->packed + HEAD;
    /* Filtered rows of measured or noisy pictures repeat nothing but runs: then searching for more makes files larger and
       needs twice the time. */
    const bool runs = deflate_text(g->text, some, Z_RLE, Z_FINISH, out, room) <=
                      deflate_text(g->text, some, Z_DEFAULT_STRATEGY, Z_FINISH, out, room);
    const bool last = s->done + g->first + g->rows == s->height;
    g->count = deflate_text(g->text, g->length, runs ? Z_RLE : Z_DEFAULT_STRATEGY,
                            last ? Z_FINISH : Z_SYNC_FLUSH, out, room);
    g->adler = (uint32_t)adler32(1, g->text, (uInt)g->length);
}

/* ---- a batch ---- */

/* Prepares the segments of the batch; returns their number, or -1 if out of memory. */
static int cut(WrPngStream *s)
{
    int count = 0;
    for (int first = 0; first < s->held; first += s->per, count++) {
        Segment *g = &s->segment[count];
        const int left = s->held - first;
        g->first = first;
        g->rows = left < s->per ? left : s->per;
        g->length = (s->row + 1) * (size_t)g->rows;
        g->count = 0;
        const size_t most = (s->row + 1) * (size_t)s->per;
        if (!g->text) g->text = wr_try_alloc_unset(most, 1, "rows of a picture", NULL);
        if (!g->packed)
            g->packed =
                wr_try_alloc_unset(HEAD + room_of(most) + TAIL, 1, "rows of a picture", NULL);
        if (!g->text || !g->packed) return -1;
    }
    return count;
}

/* A zlib stream begins with its method and window, 32 KB, and ends with the checksum of its text (RFC 1950). */
static void pass_on(WrPngStream *s, Segment *g, WrPngChunk out, void *ctx)
{
    uint8_t *from = g->packed + HEAD, *end = from + g->count;
    s->adler = (uint32_t)adler32_combine(s->adler, g->adler, (z_off_t)g->length);
    if (s->done + g->first == 0) from -= HEAD, from[0] = 0x78, from[1] = 0x5e;
    if (s->done + g->first + g->rows == s->height)
        for (int k = 0; k < TAIL; k++) *end++ = (uint8_t)(s->adler >> (24 - 8 * k));
    out(ctx, from, (size_t)(end - from));
}

static bool flush_batch(WrPngStream *s, WrPngChunk out, void *ctx)
{
    const int count = cut(s);
    if (count < 0) return false;
    if (!wr_pool_run(s->pool, count, pack, s)) return true;
    for (int k = 0; k < count; k++)
        if (s->segment[k].count == 0) return false;
    for (int k = 0; k < count; k++) pass_on(s, &s->segment[k], out, ctx);
    memcpy(s->rows, s->rows + (size_t)s->held * s->pitch, s->pitch);
    s->done += s->held;
    s->held = 0;
    return true;
}

/* ---- the stream ---- */

WrPngStream *wr_png_stream_new(size_t row, int pixel, int height, bool words, WrPool *pool)
{
    const uint16_t one = 1;
    uint8_t first;
    memcpy(&first, &one, 1);
    const int per = row + 1 < SEGMENT ? (int)(SEGMENT / (row + 1)) : 1;
    WrPngStream *s = wr_alloc(1, sizeof *s);
    *s = (WrPngStream){ .row = row,
                        .pitch = MARGIN + row,
                        .pixel = pixel,
                        .height = height,
                        .swaps = words && first == 1,
                        .pool = pool,
                        .per = per < height ? per : height,
                        .most = BATCH * per < height ? BATCH * per : height,
                        .adler = 1 };
    s->rows = wr_try_alloc(1 + (size_t)s->most, s->pitch, "rows of a picture", NULL);
    s->candidate = wr_try_alloc_unset((size_t)BATCH * FILTERS, row, "rows of a picture", NULL);
    if (s->rows && s->candidate) return s;
    wr_png_stream_free(s);
    return NULL;
}

void wr_png_stream_free(WrPngStream *stream)
{
    if (!stream) return;
    for (int k = 0; k < BATCH; k++) {
        wr_free(stream->segment[k].text);
        wr_free(stream->segment[k].packed);
    }
    wr_free(stream->rows);
    wr_free(stream->candidate);
    wr_free(stream);
}

bool wr_png_stream_add(WrPngStream *stream, const uint8_t *rows, int count, WrPngChunk out,
                       void *ctx)
{
    WrPngStream *s = stream;
    /* A full batch remains after a cancelled one. */
    for (int j = 0; j < count && s->held < s->most; j++, rows += s->row) {
        uint8_t *to = s->rows + (size_t)(1 + s->held++) * s->pitch + MARGIN;
        if (!s->swaps) memcpy(to, rows, s->row);
        else
            for (size_t i = 0; i < s->row; i += 2) to[i] = rows[i + 1], to[i + 1] = rows[i];
        if (s->held < s->most && s->done + s->held < s->height) continue;
        if (!flush_batch(s, out, ctx)) return false;
    }
    return true;
}
