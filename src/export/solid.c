#include "export/solid.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "export/job.h"
#include "scene/scene.h"

#include <math.h>
#include <string.h>

/* ---- file ---- */

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

/* Writes the file and verifies each part. ending: "stl", "ply" or "obj".
   Errors: another extension, cancelled, any file error; then the old file is unchanged. */
static bool solid_write(const WrSolid *solid, const char *ending, const char *path, WrError *err)
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

/* samples along each direction of a face, to find its size: they include quarters */
#define BOX_STEPS 64
#define SHARP                                                                                      \
    0.0625 /* of |mean normal|^2, at least: a point is displaced by at most 16 times its height */
#define SHEET 2.0 /* mm: default thickness of an open surface */

/* ---- points ---- */

/* Approximate d with n . d = f for all of several normals: mean f along the mean normal m, over |m|^2. */
static WrVec3 moved(WrVec3 normals, double f, int count)
{
    const WrVec3 m = v3_scale(normals, 1.0 / count);
    return v3_scale(m, f / count / fmax(v3_dot(m, m), SHARP));
}

static double height_at(WrSolid *s, const WrSolidLocation *at)
{
    double f;
    wr_scene_height(s->scene, s->field, at->u, at->v, &f, NULL, NULL);
    s->low = fmin(s->low, f);
    s->high = fmax(s->high, f);
    return f;
}

void wr_solid_point_position(WrSolid *solid, const WrSolidLocation *locations, int count, bool back,
                             float out[3])
{
    WrVec3 p = { 0, 0, 0 }, n = p, across = p;
    double f = 0.0;
    for (int i = 0; i < count; i++) {
        WrSurfacePoint o;
        wr_surface_at(&solid->scene->shape, locations[i].face, locations[i].u, locations[i].v, &o);
        p = v3_add(p, o.p);
        n = v3_add(n, o.n_unit);
        const WrVec3 c = { solid->cofactor.x * o.n_unit.x, solid->cofactor.y * o.n_unit.y,
                           solid->cofactor.z * o.n_unit.z };
        across = v3_add(across, v3_unit(c, o.n_unit));
        f += back ? solid->low : height_at(solid, &locations[i]);
    }
    p = v3_add(v3_scale(p, 1.0 / count), moved(n, f, count));
    const WrVec3 at = { (solid->stretch.x * p.x - solid->middle.x) * solid->scale,
                        (solid->stretch.y * p.y - solid->middle.y) * solid->scale,
                        (solid->stretch.z * p.z - solid->middle.z) * solid->scale };
    const WrVec3 under =
        back ? moved(across, -solid->thickness * count, count) : (WrVec3){ 0, 0, 0 };
    const WrVec3 end = v3_add(at, under);
    out[0] = (float)end.x, out[1] = (float)end.y, out[2] = (float)end.z;
}

int32_t wr_solid_add_bare(WrSolid *solid, const float at[3])
{
    if (solid->point_count == solid->point_room) {
        const int32_t room = solid->point_room ? 2 * solid->point_room : 1024;
        solid->points = wr_realloc(solid->points, (size_t)solid->point_room, (size_t)room,
                                   sizeof *solid->points);
        solid->point_room = room;
    }
    memcpy(solid->points[solid->point_count], at, sizeof *solid->points);
    return solid->point_count++;
}

int32_t wr_solid_add_point(WrSolid *solid, const WrSolidLocation *locations, int count)
{
    float at[3];
    wr_array_push(&solid->first, solid->locations.count);
    for (int i = 0; i < count; i++) wr_array_push(&solid->locations, locations[i]);
    wr_solid_point_position(solid, locations, count, false, at);
    return wr_solid_add_bare(solid, at);
}

void wr_solid_add_triangle(WrSolid *solid, const int32_t corners[3], const WrSolidLocation at[3])
{
    if (solid->triangle_count == solid->triangle_room) {
        const int32_t room = solid->triangle_room ? 2 * solid->triangle_room : 1024;
        solid->triangles = wr_realloc(solid->triangles, (size_t)solid->triangle_room, (size_t)room,
                                      sizeof *solid->triangles);
        solid->uv =
            wr_realloc(solid->uv, (size_t)solid->triangle_room, (size_t)room, sizeof *solid->uv);
        solid->triangle_room = room;
    }
    for (int k = 0; k < 3; k++) {
        float *uv = solid->uv[solid->triangle_count][k];
        solid->triangles[solid->triangle_count][k] = corners[k];
        uv[0] = (float)(at[k].u * solid->scene->replicate_u);
        uv[1] = (float)(at[k].v * solid->scene->replicate_v);
    }
    solid->triangle_count++;
}

/* ---- the scene in millimetres ---- */

static void grow(WrVec3 *low, WrVec3 *high, WrVec3 p)
{
    *low = (WrVec3){ fmin(low->x, p.x), fmin(low->y, p.y), fmin(low->z, p.z) };
    *high = (WrVec3){ fmax(high->x, p.x), fmax(high->y, p.y), fmax(high->z, p.z) };
}

/* Scales the longest side of the smooth surface to `size`, and moves its middle to the origin. */
static void set_scale(WrSolid *s)
{
    WrVec3 low = { INFINITY, INFINITY, INFINITY }, high = { -INFINITY, -INFINITY, -INFINITY };
    for (int face = 0; face < s->faces; face++) {
        const WrSurfaceCell c = wr_surface_cell(&s->scene->shape, face);
        for (int k = 0; k < (BOX_STEPS + 1) * (BOX_STEPS + 1); k++) {
            const double i = k % (BOX_STEPS + 1), j = k / (BOX_STEPS + 1);
            WrSurfacePoint o;
            wr_surface_at(&s->scene->shape, face, c.u0 + (c.u1 - c.u0) * i / BOX_STEPS,
                          c.v0 + (c.v1 - c.v0) * j / BOX_STEPS, &o);
            grow(&low, &high,
                 (WrVec3){ s->stretch.x * o.p.x, s->stretch.y * o.p.y, s->stretch.z * o.p.z });
        }
    }
    const WrVec3 d = v3_sub(high, low);
    s->middle = v3_scale(v3_add(low, high), 0.5);
    s->scale = s->true_width > 0 ? s->true_width / d.x : s->size / fmax(d.x, fmax(d.y, d.z));
}

/* A plane has its cells' width and height, if they are stated in millimetres. */
static WrScene *true_scene(const WrExportJob *job, WrSolid *s)
{
    const WrScene *scene = job->scene;
    if (!scene->cell.mm || job->options.solid_size > 0 || scene->shape.kind != WR_SURFACE_plane)
        return NULL;
    s->true_width = scene->cell.w * fabs(scene->replicate_u);
    if (!(s->true_width > 0)) return NULL;
    set_scale(s);
    WrScene *own = wr_scene_clone(scene);
    own->height = scene->cell.height / s->scale;
    return own;
}

static bool check(const WrExportJob *job, WrError *err)
{
    const WrExportOptions *o = &job->options;
    const WrSurfaceInfo *info = wr_surfaces[job->scene->shape.kind];
    if (info->held)
        return wr_fail(err,
                       "%s: solids are made of surfaces by formulas, which a %s is not; `wrinkle "
                       "help surface` lists them",
                       job->kind->name, info->name);
    if (!(o->solid_size >= 0) || !(o->solid_error > 0) || o->solid_thickness < 0)
        return wr_fail(err, "size %g, error %g, thickness %g: must be above 0, in millimetres",
                       o->solid_size, o->solid_error, o->solid_thickness);
    return true;
}

/* A tube is filled unless a thickness is given; a sheet must have one. */
static double thickness_of(const WrExportJob *job)
{
    const double requested = job->options.solid_thickness;
    return requested > 0.0 || !wr_surfaces[job->scene->shape.kind]->open ? requested : SHEET;
}

/* ---- the export ---- */

static bool make(WrSolid *s, WrError *err)
{
    WrProgressPart part;
    const WrProgress *whole = wr_progress_enter(&part, 0.0, 0.3);
    bool good = wr_solid_sample(s, err);
    wr_progress_set(whole);
    if (!good) return false;
    wr_solid_lay(s);
    wr_progress_enter(&part, 0.3, 0.7);
    good = wr_solid_refine(s, err);
    wr_progress_set(whole);
    return good && wr_solid_close(s, err);
}

static void free_solid(WrSolid *s)
{
    for (int face = 0; face < WR_SOLID_FACES; face++) wr_free(s->lattice[face].at);
    wr_array_free(&s->relief);
    wr_array_free(&s->locations);
    wr_array_free(&s->first);
    wr_free(s->points);
    wr_free(s->triangles);
    wr_free(s->uv);
}

static void report(WrExportJob *job, const WrSolid *s)
{
    WrVec3 low = { INFINITY, INFINITY, INFINITY }, high = { -INFINITY, -INFINITY, -INFINITY };
    for (int32_t i = 0; i < s->point_count; i++)
        grow(&low, &high, (WrVec3){ s->points[i][0], s->points[i][1], s->points[i][2] });
    job->report.triangles = s->triangle_count;
    job->report.solid_error = s->worst;
    job->report.solid_volume = wr_solid_volume(s);
    job->report.solid_size[0] = high.x - low.x;
    job->report.solid_size[1] = high.y - low.y;
    job->report.solid_size[2] = high.z - low.z;
    job->report.low = s->low;
    job->report.high = s->high;
}

bool wr_export_solid_write(WrExportJob *job, const char *path, WrError *err)
{
    if (!check(job, err)) return false;
    WrSolid s = { .scene = job->scene,
                  .field = job->field,
                  .pool = job->pool,
                  .size = job->options.solid_size > 0 ? job->options.solid_size : 100,
                  .error = job->options.solid_error,
                  .thickness = thickness_of(job),
                  .faces = wr_surfaces[job->scene->shape.kind]->faces,
                  .low = INFINITY,
                  .high = -INFINITY };
    wr_scene_stretch(job->scene, &s.stretch, &s.cofactor);
    WrScene *own = true_scene(job, &s);
    if (own) s.scene = own;
    else set_scale(&s);
    WrProgressPart part;
    bool good = make(&s, err);
    if (good) {
        const WrProgress *whole = wr_progress_enter(&part, 0.7, 1.0);
        report(job, &s);
        good = solid_write(&s, job->kind->ending, path, err);
        wr_progress_set(whole);
    }
    free_solid(&s);
    wr_scene_free(own);
    return good;
}
