#include "export/solid_file.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/enum_rows.h"
#include "base/text.h"

#include <string.h>

#define WORDS "Wrinkle, lengths in millimetres"
#define BLOCK ((size_t)1 << 20) /* bytes written at once */
#define LINE 256                /* maximum bytes of one entry */

/* Output buffer of the file. */
typedef struct Out {
    WrFileTarget target;
    WrText bytes;
    int64_t done, all; /* progress, in entries */
} Out;

static bool flush(Out *out, WrError *err)
{
    if (!wr_progress_report((double)out->done / (double)out->all)) return wr_fail(err, "cancelled");
    const bool good = wr_file_put(&out->target, out->bytes.data, out->bytes.length, err);
    wr_text_clear(&out->bytes);
    return good;
}

/* Counts a complete entry. */
static bool entry(Out *out, WrError *err)
{
    out->done++;
    return out->bytes.length + LINE < BLOCK || flush(out, err);
}

static void add_u32(Out *out, uint32_t x)
{
    const char bytes[4] = { (char)(x & 255), (char)(x >> 8 & 255), (char)(x >> 16 & 255),
                            (char)(x >> 24) };
    wr_text_add_n(&out->bytes, bytes, 4);
}

static void add_float(Out *out, float x)
{
    uint32_t bits;
    memcpy(&bits, &x, 4);
    add_u32(out, bits);
}

static void add_place(Out *out, const float at[3])
{
    for (int k = 0; k < 3; k++) add_float(out, at[k]);
}

/* ---- STL ---- */

static WrVec3 normal_of(const WrSolid *s, const int32_t *t)
{
    WrVec3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = (WrVec3){ s->points[t[k]][0], s->points[t[k]][1], s->points[t[k]][2] };
    return v3_unit(v3_cross(v3_sub(p[1], p[0]), v3_sub(p[2], p[0])), (WrVec3){ 0, 0, 1 });
}

static bool write_stl(const WrSolid *s, Out *out, WrError *err)
{
    char head[80] = WORDS;
    wr_text_add_n(&out->bytes, head, sizeof head);
    add_u32(out, (uint32_t)s->triangle_count);
    bool good = true;
    for (int32_t i = 0; i < s->triangle_count && good; i++) {
        const int32_t *t = s->triangles[i];
        const WrVec3 n = normal_of(s, t);
        add_place(out, (const float[3]){ (float)n.x, (float)n.y, (float)n.z });
        for (int k = 0; k < 3; k++) add_place(out, s->points[t[k]]);
        wr_text_add_n(&out->bytes, "\0", 2);
        good = entry(out, err);
    }
    return good;
}

/* ---- PLY ---- */

static bool write_ply(const WrSolid *s, Out *out, WrError *err)
{
    wr_text_addf(&out->bytes,
                 "ply\nformat binary_little_endian 1.0\ncomment " WORDS "\nelement vertex %d\n"
                 "property float x\nproperty float y\nproperty float z\nelement face %d\n"
                 "property list uchar int vertex_indices\nproperty list uchar float texcoord\n"
                 "end_header\n",
                 s->point_count, s->triangle_count);
    bool good = true;
    for (int32_t i = 0; i < s->point_count && good; i++) {
        add_place(out, s->points[i]);
        good = entry(out, err);
    }
    for (int32_t i = 0; i < s->triangle_count && good; i++) {
        wr_text_add_n(&out->bytes, "\3", 1);
        for (int k = 0; k < 3; k++) add_u32(out, (uint32_t)s->triangles[i][k]);
        wr_text_add_n(&out->bytes, "\6", 1);
        for (int k = 0; k < 6; k++) add_float(out, s->uv[i][k / 2][k % 2]);
        good = entry(out, err);
    }
    return good;
}

/* ---- OBJ ---- */

static void add_numbers(Out *out, const char *word, int count, const float *x)
{
    char number[WR_NUMBER_SIZE];
    wr_text_add(&out->bytes, word);
    for (int k = 0; k < count; k++) {
        wr_text_add(&out->bytes, " ");
        wr_text_add(&out->bytes, wr_number_print_float(x[k], number));
    }
    wr_text_add(&out->bytes, "\n");
}

/* A `vt` line is written when a corner's (u,v) differ from those that its point had last.
 * first: [2][points]: the corner with those, 3 times its triangle and its number, -1: none; then the number of their line. */
static bool write_obj_faces(const WrSolid *s, int32_t *first, Out *out, WrError *err)
{
    int32_t count = 0;
    bool good = true;
    for (int32_t i = 0; i < s->triangle_count && good; i++) {
        const int32_t *t = s->triangles[i];
        int32_t vt[3];
        for (int k = 0; k < 3; k++) {
            const int32_t was = first[t[k]];
            if (was >= 0 && memcmp(s->uv[was / 3][was % 3], s->uv[i][k], sizeof s->uv[i][k]) == 0) {
                vt[k] = first[s->point_count + t[k]];
                continue;
            }
            add_numbers(out, "vt", 2, s->uv[i][k]);
            vt[k] = ++count;
            first[t[k]] = 3 * i + k;
            first[s->point_count + t[k]] = count;
        }
        wr_text_addf(&out->bytes, "f %d/%d %d/%d %d/%d\n", t[0] + 1, vt[0], t[1] + 1, vt[1],
                     t[2] + 1, vt[2]);
        good = entry(out, err);
    }
    return good;
}

static bool write_obj(const WrSolid *s, Out *out, WrError *err)
{
    const size_t points = (size_t)s->point_count;
    int32_t *first = wr_try_alloc(2 * points, sizeof *first, "a solid", err);
    bool good = first;
    wr_text_add(&out->bytes, "# " WORDS "\no relief\n");
    for (int32_t i = 0; i < s->point_count && good; i++) {
        first[i] = -1;
        add_numbers(out, "v", 3, s->points[i]);
        good = entry(out, err);
    }
    good = good && write_obj_faces(s, first, out, err);
    wr_free(first);
    return good;
}

/* ---- the file ---- */

typedef bool Write(const WrSolid *s, Out *out, WrError *err);

static const struct {
    const char *ending;
    Write *write;
} formats[] = { { "stl", write_stl }, { "ply", write_ply }, { "obj", write_obj } };

static Write *format_of(const char *ending)
{
    for (int i = 0; i < WR_LENGTH(formats); i++)
        if (strcmp(ending, formats[i].ending) == 0) return formats[i].write;
    return NULL;
}

bool wr_solid_write(const WrSolid *solid, const char *ending, const char *path, WrError *err)
{
    Out out = { .all = (int64_t)solid->point_count + solid->triangle_count };
    Write *write = format_of(ending);
    if (!write) return wr_fail(err, "%s: no format of solids ends in .%s", path, ending);
    if (!wr_file_begin(&out.target, path, err)) return false;
    bool good = write(solid, &out, err) && flush(&out, err);
    wr_text_fini(&out.bytes);
    if (!good) {
        wr_file_abort(&out.target);
        return false;
    }
    return wr_file_commit(&out.target, err);
}
