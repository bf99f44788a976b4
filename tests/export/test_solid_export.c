/* Solids as files: closed, correctly oriented, with the volume of closed forms, and texels within the requested
   error. */
#include "test.h"
#include "field/scheme_list.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "document/document.h"
#include "export/export.h"
#include "field/field.h"
#include "image/image.h"
#include "image/mesh.h"
#include "scene/scene.h"
#include "surface/data.h"
#include "surface/projection.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

/* ---- documents ---- */

static TestRandom random_state = { 77 };

static float random_of(double low, double high)
{
    return (float)(low + (high - low) * test_random(&random_state));
}

/* A table of random heights in clusters, as in reliefs; `rough` 0: constant height. */
static WrDocument *document_of(int width, int height, double rough, WrWrap wrap)
{
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(width, height, wrap, wrap, random_of(0.1, 0.4), NULL);
    for (int j = 0; j < height && rough > 0; j++)
        for (int i = 0; i < width; i++) wr_field_set(field, i, j, random_of(-rough, rough));
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    WrScene *scene = wr_scene_clone(document->scene);
    wr_scene_free(document->scene);
    document->scene = scene;
    scene->height = 0.0713;
    scene->scheme = WR_SCHEME_BILINEAR;
    return document;
}

static void set_surface(WrDocument *document, WrSurfaceKind kind)
{
    WrShape shape;
    wr_shape_default(kind, &shape);
    wr_scene_set_shape(document->scene, &shape);
}

/* ---- files ---- */

typedef struct Body {
    WrMesh mesh;
    double volume; /* mm3 */
} Body;

static void set_options(const char *kind, const char *settings, WrExportOptions *options)
{
    char text[120], *rest = text;
    snprintf(text, sizeof text, "%s", settings);
    *options = wr_export_default();
    for (char *word; (word = strsep(&rest, " "));) {
        WrError err = { "" };
        char *equals = strchr(word, '=');
        if (!equals) continue;
        *equals = '\0';
        if (!wr_export_option(wr_export_find(kind), options, word, equals + 1, &err))
            fail_msg("%s", err.text);
    }
}

static bool try_export(const WrDocument *document, const char *kind, const char *settings,
                       const char *path, WrExportReport *report, WrError *err)
{
    WrExportOptions options;
    WrPool *pool = wr_pool_new(2);
    set_options(kind, settings, &options);
    const bool good = wr_export(wr_export_find(kind), document, &options, pool, path, report, err);
    wr_pool_free(pool);
    return good;
}

static WrVec3 point_of(const WrMesh *mesh, int32_t i)
{
    return (WrVec3){ mesh->points[i][0], mesh->points[i][1], mesh->points[i][2] };
}

static double volume_of(const WrMesh *mesh)
{
    double sum = 0;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const int32_t *t = mesh->corners[i];
        sum += v3_dot(point_of(mesh, t[0]), v3_cross(point_of(mesh, t[1]), point_of(mesh, t[2])));
    }
    return sum / 6;
}

static Body read_body(const char *path)
{
    Body body;
    WrError err = { "" };
    if (!wr_mesh_read(path, &body.mesh, &err)) fail_msg("%s", err.text);
    body.volume = volume_of(&body.mesh);
    return body;
}

static Body export_body(const WrDocument *document, const char *kind, const char *settings,
                        WrExportReport *report)
{
    char path[32];
    WrError err = { "" };
    snprintf(path, sizeof path, "body.%s", kind);
    if (!try_export(document, kind, settings, path, report, &err))
        fail_msg("%s: %s", wr_surfaces[document->scene->shape.kind]->name, err.text);
    Body body = read_body(path);
    assert_int_equal(body.mesh.triangle_count, report->triangles);
    if (!report->solid_open)
        assert_near(body.volume, report->solid_volume, 1e-5 * report->solid_volume);
    return body;
}

/* ---- closedness, by positions alone, as a slicer joins the triangles of an STL ---- */

typedef struct Corner {
    float at[3];
    int32_t of; /* three times the triangle, plus the corner */
} Corner;

static int by_place(const void *a, const void *b)
{
    const Corner *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->at[k] != q->at[k]) return p->at[k] < q->at[k] ? -1 : 1;
    return 0;
}

static int by_value(const void *a, const void *b)
{
    const int64_t p = *(const int64_t *)a, q = *(const int64_t *)b;
    return (p > q) - (p < q);
}

/* Each side once in each direction; no degenerate triangle; Euler's number. */
static int64_t check_closed(const WrMesh *mesh, const char *what)
{
    const int32_t count = 3 * mesh->triangle_count;
    Corner *corners = wr_alloc((size_t)count, sizeof *corners);
    int32_t *name = wr_alloc((size_t)count, sizeof *name);
    int64_t *sides = wr_alloc((size_t)count, sizeof *sides),
            *back = wr_alloc((size_t)count, sizeof *back);
    int32_t places = 0;
    for (int32_t i = 0; i < count; i++) {
        memcpy(corners[i].at, mesh->points[mesh->corners[i / 3][i % 3]], sizeof corners[i].at);
        corners[i].of = i;
    }
    qsort(corners, (size_t)count, sizeof *corners, by_place);
    for (int32_t i = 0; i < count; i++) {
        places += i == 0 || by_place(&corners[i - 1], &corners[i]) != 0;
        name[corners[i].of] = places - 1;
    }
    for (int32_t i = 0; i < count; i++) {
        const int64_t a = name[i], b = name[i - i % 3 + (i + 1) % 3];
        if (a == b) fail_msg("%s: triangle %d has no area", what, i / 3);
        sides[i] = a << 32 | b;
        back[i] = b << 32 | a;
    }
    qsort(sides, (size_t)count, sizeof *sides, by_value);
    qsort(back, (size_t)count, sizeof *back, by_value);
    for (int32_t i = 0; i < count; i++) {
        if (sides[i] != back[i]) fail_msg("%s: not closed", what);
        if (i > 0 && sides[i] == sides[i - 1]) fail_msg("%s: a side twice", what);
    }
    wr_free(corners);
    wr_free(name);
    wr_free(sides);
    wr_free(back);
    return places - count / 2 + mesh->triangle_count;
}

/* ---- tests ---- */

static void a_flat_plane_is_a_box(void **state)
{
    (void)state;
    WrExportReport report;
    WrDocument *document = document_of(19, 31, 0, WR_WRAP_PERIODIC);
    document->scene->shape.value[0] = 1.37;
    document->scene->shape.value[1] = 0.71;
    Body body = export_body(document, "stl", "size=83.7 thickness=3.31", &report);
    const double volume = 83.7 * (83.7 * 0.71 / 1.37) * 3.31;
    assert_near(body.volume, volume, 1e-6 * volume);
    assert_near(report.solid_size[0], 83.7, 1e-4);
    assert_near(report.solid_size[1], 83.7 * 0.71 / 1.37, 1e-4);
    assert_near(report.solid_size[2], 3.31, 1e-5);
    assert_true(report.triangles <= 40 && report.solid_error < 1e-5);
    assert_int_equal(check_closed(&body.mesh, "box"), 2);
    wr_mesh_fini(&body.mesh);
    wr_document_free(document);
}

/* HC155: the smallest tables; the requested thickness under the lowest sample, however low that is. */
static void hc155_the_smallest_tables_are_closed_too(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 1, 1 }, { 2, 2 }, { 1, 3 }, { 3, 2 } };
    for (int k = 0; k < 4; k++) {
        const int w = sizes[k][0], h = sizes[k][1];
        WrExportReport report;
        WrDocument *document = document_of(w, h, 0, WR_WRAP_PERIODIC);
        WrField *field = wr_field_new(w, h, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
        for (int i = 0; i < w * h; i++)
            wr_field_set(field, i % w, i / w, -7.3f + (float)(i * i % 5) * 0.61f);
        wr_field_free(document->layers[0].heights);
        document->layers[0].heights = field;
        Body body = export_body(document, "stl", "size=41.3 error=0.01 thickness=1.7", &report);
        const double area = report.solid_size[0] * report.solid_size[1];
        assert_int_equal(check_closed(&body.mesh, "small"), 2);
        assert_true(body.volume > area * 1.7 * (1 - 1e-6));
        assert_true(body.volume < area * report.solid_size[2] * (1 + 1e-6));
        if (w * h == 1) assert_near(report.solid_size[2], 1.7, 1e-5);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* Corners are on the surface, so a convex solid is smaller, by at most its error over the whole area. */
static void smooth_bodies_have_the_volumes_of_their_formulas(void **state)
{
    (void)state;
    const double e = 0.0217, size = 47.3;
    for (int which = 0; which < 3; which++) {
        WrExportReport report;
        WrDocument *document = document_of(23, 17, 0, WR_WRAP_PERIODIC);
        static const WrSurfaceKind kinds[] = { WR_SURFACE_sphere, WR_SURFACE_cylinder,
                                               WR_SURFACE_cylinder };
        set_surface(document, kinds[which]);
        const double *value = document->scene->shape.value;
        float f;
        wr_field_read(document->layers[0].heights, 0, 0, 1, 1, &f, 1);
        const double rise = f * document->scene->height;
        Body body = export_body(document, "ply",
                                which == 2 ? "size=47.3 error=0.0217 thickness=1.9"
                                           : "size=47.3 error=0.0217",
                                &report);
        assert_true(report.solid_error <= e && report.solid_error > 0.2 * e);
        double volume, area;
        if (which == 0) {
            const double r = size / 2 * (1 + rise / value[0]);
            volume = 4 * M_PI / 3 * r * r * r, area = 4 * M_PI * r * r;
        } else {
            const double unit = size / fmax(2 * value[0], value[1]);
            const double r = unit * (value[0] + rise), h = unit * value[1];
            const double inner = which == 2 ? r - 1.9 : 0;
            volume = M_PI * (r * r - inner * inner) * h, area = 2 * M_PI * r * h;
        }
        assert_true(body.volume < volume * (which == 2 ? 1.01 : 1 + 1e-6));
        assert_true(body.volume > volume - 1.01 * e * area);
        assert_int_equal(check_closed(&body.mesh, "smooth"), which == 2 ? 0 : 2);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* Every surface by a formula, tables of odd sizes, all schemes, odd and broken repeats, stretched and mirrored. */
static void every_surface_is_closed(void **state)
{
    (void)state;
    static const char *const kinds[] = { "stl", "ply", "obj" };
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        if (wr_surfaces[kind]->held) continue;
        WrExportReport report;
        WrDocument *document =
            document_of(5 + kind, 23 - kind, 0.5, kind % 3 ? WR_WRAP_PERIODIC : WR_WRAP_CLAMP);
        set_surface(document, (WrSurfaceKind)kind);
        document->scene->scheme = (WrScheme)(kind % WR_SCHEME_COUNT);
        if (kind % 2) document->scene->replicate_u = 2;
        if (kind % 5 == 1) document->scene->replicate_v = -1.37;
        if (kind % 4 == 3) document->scene->sizes = (WrVec3){ 1.31, -0.83, 0.97 };
        Body body =
            export_body(document, kinds[kind % 3],
                        kind == WR_SURFACE_cone ? "size=31.7 error=0.31" /* no wall at its tip */
                                                : "size=31.7 error=0.31 thickness=0.61",
                        &report);
        const int64_t euler = check_closed(&body.mesh, wr_surfaces[kind]->name);
        const bool ring = kind == WR_SURFACE_torus || kind == WR_SURFACE_cylinder;
        if (kind != WR_SURFACE_revolution) assert_int_equal(euler, ring ? 0 : 2);
        assert_true(body.volume > 0 && report.solid_error <= 0.31f);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* The square of the distance of p from a triangle: over a + s e + t f it is a quadratic in s and t. */
static double distance2(WrVec3 p, WrVec3 a, WrVec3 b, WrVec3 c)
{
    const WrVec3 e = v3_sub(b, a), f = v3_sub(c, a), g = v3_sub(p, a);
    const double ee = v3_dot(e, e), ef = v3_dot(e, f), ff = v3_dot(f, f);
    const double eg = v3_dot(e, g), fg = v3_dot(f, g), det = ee * ff - ef * ef;
    const double s = (ff * eg - ef * fg) / det, t = (ee * fg - ef * eg) / det;
    if (s >= 0 && t >= 0 && s + t <= 1) {
        const WrVec3 d = v3_mad(v3_mad(g, e, -s), f, -t);
        return v3_dot(d, d);
    }
    const WrVec3 from[3] = { a, b, c }, to[3] = { b, c, a };
    double least = INFINITY;
    for (int k = 0; k < 3; k++) {
        const WrVec3 side = v3_sub(to[k], from[k]), q = v3_sub(p, from[k]);
        const double x = fmin(fmax(v3_dot(q, side) / v3_dot(side, side), 0), 1);
        const WrVec3 d = v3_mad(q, side, -x);
        least = fmin(least, v3_dot(d, d));
    }
    return least;
}

static double distance(const WrMesh *mesh, WrVec3 p)
{
    double least = INFINITY;
    for (int32_t i = 0; i < mesh->triangle_count; i++) {
        const int32_t *t = mesh->corners[i];
        least = fmin(
            least, distance2(p, point_of(mesh, t[0]), point_of(mesh, t[1]), point_of(mesh, t[2])));
    }
    return sqrt(least);
}

/* The texel's position in millimetres, by independent formulas: a plane a by b, a torus. */
static WrVec3 texel(const WrDocument *document, bool torus, int i, int j, double size)
{
    const WrField *field = document->layers[0].heights;
    const double *value = document->scene->shape.value;
    const double u = (i + 0.5) / wr_field_width(field), v = 1 - (j + 0.5) / wr_field_height(field);
    float f;
    wr_field_read(field, i, j, 1, 1, &f, 1);
    const double h = document->scene->height * f;
    if (!torus) {
        const double unit = size / fmax(value[0], value[1]);
        return (WrVec3){ unit * value[0] * (u - 0.5), unit * value[1] * (v - 0.5), unit * h };
    }
    const double R = value[0], r = value[1], unit = size / (2 * (R + r));
    const double x = 2 * M_PI * u, y = 2 * M_PI * v, d = R + (r + h) * cos(y);
    return (WrVec3){ unit * d * cos(x), unit * d * sin(x), unit * (r + h) * sin(y) };
}

static void no_texel_is_farther_off_than_was_asked(void **state)
{
    (void)state;
    int64_t before = 0;
    for (int which = 0; which < 4; which++) {
        static const char *const settings[] = { "size=61.3 error=0.173", "size=61.3 error=0.73",
                                                "size=61.3 error=0.211", "size=61.3 error=0.93" };
        static const double errors[] = { 0.173, 0.73, 0.211, 0.93 };
        WrExportReport report;
        WrDocument *document = document_of(17, 13, 0.4, WR_WRAP_PERIODIC);
        const bool torus = which >= 2;
        if (torus) set_surface(document, WR_SURFACE_torus);
        Body body = export_body(document, "ply", settings[which], &report);
        double worst = 0;
        for (int j = 0; j < 13; j++)
            for (int i = 0; i < 17; i++)
                worst = fmax(worst, distance(&body.mesh, texel(document, torus, i, j, 61.3)));
        assert_true(report.solid_error <= (float)errors[which]);
        if (worst > report.solid_error + 2e-5)
            fail_msg("%d: %g, told %g", which, worst, report.solid_error);
        assert_true(worst > 0.1 * errors[which]); /* no finer than requested */
        if (which % 2) assert_true(report.triangles < before);
        before = report.triangles;
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

static void what_cannot_be_made_is_told(void **state)
{
    (void)state;
    static const struct {
        int kind;
        const char *settings, *path, *part;
    } bad[] = {
        { WR_SURFACE_plane, "", "a.png", "stl files end in .stl" },
        { WR_SURFACE_mesh, "", "a.stl", "has no file" },
        { WR_SURFACE_cone, "thickness=60", "a.stl", "too thick for the curvature" },
        { WR_SURFACE_sphere, "triangles=317", "a.stl", "needs more than 317 triangles" },
        { WR_SURFACE_plane, "size=1000 error=1e-6", "a.stl", "needs more than" },
    };
    const int count = 5 - (getenv("WR_FULL") == NULL); /* the last needs seconds */
    WrError err = { "" };
    assert_true(wr_file_write("a.stl", "old", 3, &err) && wr_file_write("a.png", "old", 3, &err));
    for (int i = 0; i < count; i++) {
        WrExportReport report;
        WrDocument *document = document_of(9, 7, 0.5, WR_WRAP_PERIODIC);
        set_surface(document, (WrSurfaceKind)bad[i].kind);
        assert_false(try_export(document, "stl", bad[i].settings, bad[i].path, &report, &err));
        if (!strstr(err.text, bad[i].part)) fail_msg("%s: not \"%s\"", err.text, bad[i].part);
        char *bytes;
        size_t length;
        assert_true(wr_file_read(bad[i].path, 99, &bytes, &length, &err));
        assert_string_equal(bytes, "old");
        wr_free(bytes);
        wr_document_free(document);
    }
    static const char *const values[] = { "0", "-1", "1e7", "nan", "", "2mm" };
    static const char *const names[] = { "size", "error", "thickness" };
    for (int i = 0; i < 18; i++) {
        WrExportOptions options = wr_export_default();
        assert_false(
            wr_export_option(wr_export_find("ply"), &options, names[i % 3], values[i / 3], &err));
        assert_non_null(strstr(err.text, "must be millimetres"));
    }
}

static void an_stl_says_millimetres(void **state)
{
    (void)state;
    WrExportReport report;
    WrDocument *document = document_of(9, 7, 0.5, WR_WRAP_PERIODIC);
    Body body = export_body(document, "stl", "error=2", &report);
    char *bytes;
    size_t length;
    WrError err;
    assert_true(wr_file_read("body.stl", 1 << 20, &bytes, &length, &err));
    assert_int_equal(length, 84 + 50 * report.triangles);
    assert_non_null(strstr(bytes, "millimetres"));
    assert_memory_not_equal(bytes, "solid", 5); /* that would be a text file */
    for (int64_t i = 0; i < report.triangles; i++) {
        float n[12];
        memcpy(n, bytes + 84 + 50 * i, sizeof n);
        const WrVec3 p = { n[3], n[4], n[5] }, q = { n[6], n[7], n[8] }, r = { n[9], n[10], n[11] };
        const WrVec3 want = v3_unit(v3_cross(v3_sub(q, p), v3_sub(r, p)), p);
        assert_near(v3_dot(want, (WrVec3){ n[0], n[1], n[2] }), 1, 1e-5);
    }
    wr_free(bytes);
    wr_mesh_fini(&body.mesh);
    wr_document_free(document);
}

/* ---- (u,v) ---- */

static WrMesh read_whole(const char *path)
{
    WrMesh mesh;
    WrError err = { "" };
    if (!wr_mesh_read_attributes(path, &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

/* Of a flat plane of 1.37 x 0.71 with its middle at the origin, 3 x 2 cells: u is 3 (x / 83.7 + 1/2), and v likewise; walls
   and back have those of the relief above them, and the middle of the back, too, those of the middle. */
static void bodies_have_coordinates_of_their_cells(void **state)
{
    (void)state;
    static const char *const kinds[] = { "obj", "ply" };
    const double width = 83.7, height = 83.7 * 0.71 / 1.37;
    for (int k = 0; k < 2; k++) {
        WrExportReport report;
        WrDocument *document = document_of(19, 31, 0.3, WR_WRAP_PERIODIC);
        document->scene->shape.value[0] = 1.37;
        document->scene->shape.value[1] = 0.71;
        document->scene->replicate_u = 3;
        document->scene->replicate_v = 2;
        Body body = export_body(document, kinds[k], "size=83.7 error=0.3 thickness=3", &report);
        WrMesh mesh = read_whole(k == 0 ? "body.obj" : "body.ply");
        int checked = 0;
        for (int32_t i = 0; i < 3 * mesh.triangle_count; i++) {
            const int32_t c = mesh.corners[i / 3][i % 3];
            const float *p = mesh.points[c], *uv = mesh.uv[c];
            if (fabs((double)p[0]) < 1e-3 && fabs((double)p[1]) < 1e-3)
                continue; /* the back's middle */
            assert_near((double)uv[0], 3 * ((double)p[0] / width + 0.5), 1e-4);
            assert_near((double)uv[1], 2 * ((double)p[1] / height + 0.5), 1e-4);
            checked++;
        }
        assert_true(checked > 3000);
        assert_int_equal(check_closed(&body.mesh, kinds[k]), 2);
        wr_mesh_fini(&mesh);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* Where a tube closes, u goes on to 1 and does not jump back: no triangle has corners more than half a turn apart, and all
   have the angle of their place. */
static void coordinates_do_not_jump_at_a_seam(void **state)
{
    (void)state;
    WrExportReport report;
    WrDocument *document = document_of(19, 31, 0.3, WR_WRAP_PERIODIC);
    set_surface(document, WR_SURFACE_cylinder);
    Body body = export_body(document, "obj", "size=50 error=0.2 thickness=2", &report);
    WrMesh mesh = read_whole("body.obj");
    for (int32_t t = 0; t < mesh.triangle_count; t++) {
        double low = INFINITY, high = -INFINITY;
        for (int k = 0; k < 3; k++) {
            const int32_t c = mesh.corners[t][k];
            const double u = (double)mesh.uv[c][0], x = (double)mesh.points[c][0],
                         y = (double)mesh.points[c][1];
            const double turn = atan2(y, x) / (2 * M_PI) - u;
            assert_near(turn - rint(turn), 0, 1e-4);
            low = fmin(low, u), high = fmax(high, u);
        }
        if (high - low > 0.5) fail_msg("triangle %d: u from %g to %g", t, low, high);
    }
    wr_mesh_fini(&mesh);
    wr_mesh_fini(&body.mesh);
    wr_document_free(document);
}

/* ---- models ---- */

/* The PNG files in a GLB, which are the only places with their eight first bytes. */
static WrImage *picture_in(const char *path, int which)
{
    static const char head[] = "\x89PNG\r\n\x1a\n";
    WrError err = { "" };
    FILE *file = fopen(path, "rb");
    char *bytes = wr_alloc(1 << 22, 1);
    const size_t length = fread(bytes, 1, 1 << 22, file);
    fclose(file);
    const char *at = bytes;
    for (int k = 0; k <= which; k++) {
        at = memmem(at + (k > 0), length - (size_t)(at - bytes) - (k > 0), head, 8);
        if (!at) fail_msg("%s: %d pictures", path, k);
    }
    WrImage *image = wr_image_read_bytes("map.png", at, length - (size_t)(at - bytes), &err);
    if (!image) fail_msg("%s", err.text);
    wr_free(bytes);
    return image;
}

static WrMesh export_model(const WrDocument *document, const char *settings, WrExportReport *report)
{
    WrError err = { "" };
    if (!try_export(document, "glb", settings, "model.glb", report, &err)) fail_msg("%s", err.text);
    WrMesh mesh = read_whole("model.glb");
    assert_int_equal(mesh.triangle_count, report->triangles);
    return mesh;
}

/* A plane of 2 x 1 with 4 x 2 cells of 1/2 x 1/2 (its u 0..4), as a ramp of slope 1/2 along u: its normal is (-1, 0, 2) / sqrt 5
   inside, code 255 (n/2 + 1/2) before rounding. */
static void a_model_has_the_slopes_of_its_cells(void **state)
{
    (void)state;
    WrExportReport report;
    WrDocument *document = document_of(16, 16, 0, WR_WRAP_CLAMP);
    WrField *field = wr_field_new(16, 16, WR_WRAP_CLAMP, WR_WRAP_CLAMP, 0, NULL);
    for (int i = 0; i < 256; i++) wr_field_set(field, i % 16, i / 16, (float)(i % 16) / 16);
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    document->scene->height = 0.25; /* of F from 0 to 1 across a cell 1/2 wide */
    document->scene->shape.value[0] = 2;
    document->scene->shape.value[1] = 1;
    document->scene->replicate_u = 4;
    document->scene->replicate_v = 2;
    WrMesh mesh = export_model(document, "", &report);
    assert_int_equal(report.pictures, 2);
    for (int32_t i = 0; i < mesh.point_count; i++) {
        const float *p = mesh.points[i], *uv = mesh.uv[i];
        assert_near((double)uv[0], 4 * (double)p[0] / 2, 1e-6);
        assert_near((double)uv[1], 2 * (double)p[1] / 1, 1e-6);
        assert_near((double)mesh.normals[i][2], 1, 0);
    }
    WrImage *map = picture_in("model.glb", 0);
    assert_int_equal(map->width, 16);
    for (int c = 0; c < 3; c++) {
        const double normal[3] = { -1 / sqrt(5), 0, 2 / sqrt(5) };
        const float *middle = map->data + (8 * 16 + 8) * map->channels;
        assert_near(255 * (double)middle[c], 255 * (normal[c] / 2 + 0.5), 0.51);
    }
    wr_image_free(map);
    wr_mesh_fini(&mesh);
    wr_document_free(document);
}

/* Every surface by a formula: places and normals are the surface's own at the file's (u,v), and face outwards. */
static void every_surface_is_a_model(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        if (wr_surfaces[kind]->held) continue;
        WrExportReport report;
        WrDocument *document = document_of(8, 8, 0.1, WR_WRAP_PERIODIC);
        set_surface(document, (WrSurfaceKind)kind);
        WrMesh mesh = export_model(document, "directions=4", &report);
        const double radius = wr_shape_radius(&document->scene->shape);
        int wrong = 0;
        for (int32_t i = 0; i < mesh.point_count; i++) {
            double best = INFINITY;
            for (int face = 0; face < wr_surfaces[kind]->faces; face++) {
                WrSurfacePoint o;
                wr_surface_at(&document->scene->shape, face, (double)mesh.uv[i][0],
                              (double)mesh.uv[i][1], &o);
                const WrVec3 n = { (double)mesh.normals[i][0], (double)mesh.normals[i][1],
                                   (double)mesh.normals[i][2] };
                const double far = v3_len(v3_sub(o.p, point_of(&mesh, i)));
                best = fmin(best, far / radius + 1e-2 * v3_len(v3_sub(n, o.n_unit)));
            }
            wrong += !(best < 1e-4);
        }
        if (wrong)
            fail_msg("%s: %d of %d points", wr_surfaces[kind]->name, wrong, mesh.point_count);
        for (int32_t t = 0; t < mesh.triangle_count; t++) {
            const int32_t *c = mesh.corners[t];
            const WrVec3 a = point_of(&mesh, c[0]), b = point_of(&mesh, c[1]),
                         d = point_of(&mesh, c[2]);
            const WrVec3 n = v3_cross(v3_sub(b, a), v3_sub(d, a));
            double facing = 0;
            for (int k = 0; k < 3; k++)
                facing += v3_dot(n, (WrVec3){ (double)mesh.normals[c[k]][0],
                                              (double)mesh.normals[c[k]][1],
                                              (double)mesh.normals[c[k]][2] });
            wrong += !(facing > 0);
        }
        if (wrong * 100 > mesh.triangle_count)
            fail_msg("%s: %d of %d triangles face inwards", wr_surfaces[kind]->name, wrong,
                     mesh.triangle_count);
        wr_mesh_fini(&mesh);
        wr_document_free(document);
    }
}

/* A mesh, patches and a terrain, each its square of side 1, under a ramp of slope 1/4 along u: normal (-1, 0, 4) / sqrt 17. */
static void held_triangles_are_a_model(void **state)
{
    (void)state;
    for (int kind = 0; kind < WR_SURFACE_COUNT; kind++) {
        if (!wr_surfaces[kind]->held) continue;
        WrExportReport report;
        WrDocument *document = document_of(16, 16, 0, WR_WRAP_CLAMP);
        for (int i = 0; i < 256; i++)
            wr_field_set(document->layers[0].heights, i % 16, i / 16, (float)(i % 16) / 16);
        set_surface(document, (WrSurfaceKind)kind);
        document->scene->height = 0.25;
        WrMesh mesh = export_model(document, "", &report);
        assert_int_equal(mesh.triangle_count, 2);
        assert_int_equal(report.pictures, 2);
        WrImage *map = picture_in("model.glb", 0);
        for (int c = 0; c < 3; c++) {
            const double normal[3] = { -1 / sqrt(17), 0, 4 / sqrt(17) };
            const float *middle = map->data + (8 * 16 + 8) * map->channels;
            assert_near(255 * (double)middle[c], 255 * (normal[c] / 2 + 0.5), 0.51);
        }
        wr_image_free(map);
        wr_mesh_fini(&mesh);
        wr_document_free(document);
    }
}

/* ---- relief on meshes ---- */

typedef struct Quads {
    float points[4 * 400][3], normals[4 * 400][3], uv[4 * 400][2];
    int32_t corners[2 * 400][3], count;
} Quads;

static void add_corner(Quads *q, int32_t i, WrVec3 p, WrVec3 n, double u, double v)
{
    q->points[i][0] = (float)p.x, q->points[i][1] = (float)p.y, q->points[i][2] = (float)p.z;
    q->normals[i][0] = (float)n.x, q->normals[i][1] = (float)n.y, q->normals[i][2] = (float)n.z;
    q->uv[i][0] = (float)u, q->uv[i][1] = (float)v;
}

/* Two triangles on p, p + a, p + a + b, p + b, whose normal is a x b; one unit is `per` cells. */
static void add_quad(Quads *q, WrVec3 p, WrVec3 a, WrVec3 b, double per)
{
    const WrVec3 n = v3_unit(v3_cross(a, b), (WrVec3){ 0, 0, 1 });
    const double u = test_random(&random_state), v = test_random(&random_state);
    const int32_t i = 4 * q->count;
    const WrVec3 c = v3_add(p, a);
    add_corner(q, i, p, n, u, v);
    add_corner(q, i + 1, c, n, u + per * v3_len(a), v);
    add_corner(q, i + 2, v3_add(c, b), n, u + per * v3_len(a), v + per * v3_len(b));
    add_corner(q, i + 3, v3_add(p, b), n, u, v + per * v3_len(b));
    memcpy(q->corners[2 * q->count], (const int32_t[]){ i, i + 1, i + 2 }, 12);
    memcpy(q->corners[2 * q->count++ + 1], (const int32_t[]){ i, i + 2, i + 3 }, 12);
}

static const double box[3] = { 2.371, 1.613, 0.937 };

static void add_box(Quads *q, double per)
{
    for (int k = 0; k < 6; k++) {
        double a[3] = { 0 }, b[3] = { 0 }, p[3];
        const int x = k % 3, y = (k + 1) % 3, z = (k + 2) % 3;
        for (int c = 0; c < 3; c++) p[c] = -box[c] / 2;
        if (k > 2) p[z] = -p[z];
        a[k > 2 ? x : y] = box[k > 2 ? x : y];
        b[k > 2 ? y : x] = box[k > 2 ? y : x];
        add_quad(q, (WrVec3){ p[0], p[1], p[2] }, (WrVec3){ a[0], a[1], a[2] },
                 (WrVec3){ b[0], b[1], b[2] }, per);
    }
}

static const double ring[2] = { 2.113, 0.811 }; /* R, r */

/* Every quad of a torus of 13 by 7 has corners of its own, equal at equal places up to u or v = 1. */
static void add_torus(Quads *q)
{
    for (int k = 0; k < 13 * 7; k++, q->count++) {
        static const int at[4][2] = { { 0, 0 }, { 1, 0 }, { 1, 1 }, { 0, 1 } };
        for (int c = 0; c < 4; c++) {
            const int i = k % 13 + at[c][0], j = k / 13 + at[c][1];
            const double s = 2 * M_PI * (i % 13) / 13, t = 2 * M_PI * (j % 7) / 7;
            const WrVec3 n = { cos(s) * cos(t), sin(s) * cos(t), sin(t) };
            const WrVec3 m = { ring[0] * cos(s), ring[0] * sin(s), 0 };
            add_corner(q, 4 * k + c, v3_mad(m, n, ring[1]), n, i / 13.0, j / 7.0);
        }
        memcpy(q->corners[2 * k], (const int32_t[]){ 4 * k, 4 * k + 1, 4 * k + 2 }, 12);
        memcpy(q->corners[2 * k + 1], (const int32_t[]){ 4 * k, 4 * k + 2, 4 * k + 3 }, 12);
    }
}

/* The document's surface becomes the mesh; `without` triangles are left out at its end. */
static void set_mesh(WrDocument *document, Quads *q, int without)
{
    WrError err = { "" };
    const int32_t count = 2 * q->count - without, half = q->count;
    const WrTrianglePart parts[2] = { { .name = "one", .count = half },
                                      { .name = "two", .first = half, .count = count - half } };
    const WrTrianglesSource source = { .parts = parts,
                                       .part_count = 2,
                                       .points = (const float(*)[3])q->points,
                                       .normals = (const float(*)[3])q->normals,
                                       .uv = (const float(*)[2])q->uv,
                                       .corners = (const int32_t(*)[3])q->corners,
                                       .point_count = 4 * q->count,
                                       .triangle_count = count };
    WrTriangles *mesh = wr_triangles_new(&source, &err);
    if (!mesh) fail_msg("%s", err.text);
    wr_scene_set_triangles(document->scene, mesh, "test", NULL);
    wr_free(q);
}

static Quads *new_quads(void)
{
    return wr_alloc(1, sizeof(Quads));
}

static double height_of(const WrDocument *document)
{
    float f;
    wr_field_read(document->layers[0].heights, 0, 0, 1, 1, &f, 1);
    return (double)f * document->scene->height;
}

/* A constant height moves each face of a box along its normal: hard edges stay where the planes meet. */
static void a_box_grows_on_all_sides(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        static const char *const settings[] = { "error=0.003", "error=0.003 edges=round",
                                                "error=0.03 size=50", "error=0.003" };
        WrExportReport report;
        WrDocument *document = document_of(7, 11, 0, WR_WRAP_PERIODIC);
        Quads *q = new_quads();
        add_box(q, 3.7);
        set_mesh(document, q, 0);
        if (k == 3) document->scene->sizes = (WrVec3){ -1, 1, 0.5 };
        const double h = height_of(document), unit = k == 2 ? 50 / box[0] : 1;
        const double flat = k == 3 ? 0.5 : 1, volume = (box[0] + 2 * h) * (box[1] + 2 * h) *
                                                       (box[2] + 2 * h) * pow(unit, 3) * flat;
        Body body = export_body(document, "stl", settings[k], &report);
        assert_int_equal(check_closed(&body.mesh, "box"), 2);
        assert_false(report.solid_open);
        assert_int_equal(report.solid_folds, 0);
        if (k == 1) assert_true(body.volume < volume * 0.9999 && body.volume > volume * 0.98);
        else assert_near(body.volume, volume, 2e-6 * volume);
        assert_near(report.solid_size[0], (box[0] + 2 * h) * unit, (k == 1 ? 0.02 : 1e-5) * unit);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* Bilinear F of a periodic table, independently of the program's schemes. */
static double bilinear(const WrField *field, double u, double v)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const double x = u * w - 0.5, y = (1 - v) * h - 0.5; /* row 0 is at the top */
    const int i = (int)floor(x), j = (int)floor(y);
    double sum = 0;
    for (int k = 0; k < 4; k++) {
        float f;
        const int a = i + (k & 1), b = j + (k >> 1);
        wr_field_read(field, (a % w + w) % w, (b % h + h) % h, 1, 1, &f, 1);
        sum += (double)f * (k & 1 ? x - i : 1 - x + i) * (k >> 1 ? y - j : 1 - y + j);
    }
    return sum;
}

/* 10 000 random points of the exact surface, evaluated here, are within the error; smooth meshes with seams of (u,v),
   closed and open. */
static void relief_on_a_mesh_keeps_to_the_error(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrExportReport report;
        WrDocument *document = document_of(13, 9, 0.6, WR_WRAP_PERIODIC);
        Quads *q = new_quads(), *copy = new_quads();
        add_torus(q);
        *copy = *q;
        set_mesh(document, q, k);
        document->scene->replicate_u = 3, document->scene->replicate_v = -2;
        const double e = 0.0091;
        Body body = export_body(document, k ? "ply" : "stl", "error=0.0091", &report);
        if (k == 0) assert_int_equal(check_closed(&body.mesh, "torus"), 0);
        assert_int_equal(report.solid_open, k);
        assert_true(report.solid_error <= e && report.solid_error > 0.5 * e);
        double worst = 0;
        for (int i = test_amount(0, 9700); i < 10000; i++) {
            const int t = (int)(test_random(&random_state) * (2 * copy->count - k));
            double b = test_random(&random_state), c = test_random(&random_state);
            if (b + c > 1) b = 1 - b, c = 1 - c;
            const double weight[3] = { 1 - b - c, b, c };
            WrVec3 p = { 0, 0, 0 }, n = p;
            double u = 0, v = 0;
            for (int m = 0; m < 3; m++) {
                const int32_t at = copy->corners[t][m];
                const float *own = copy->points[at], *up = copy->normals[at];
                p = v3_mad(p, (WrVec3){ own[0], own[1], own[2] }, weight[m]);
                n = v3_mad(n, (WrVec3){ up[0], up[1], up[2] }, weight[m]);
                u += weight[m] * (double)copy->uv[at][0], v += weight[m] * (double)copy->uv[at][1];
            }
            const double f = bilinear(document->layers[0].heights, 3 * u, -2 * v);
            n = v3_unit(n, n);
            worst = fmax(worst, distance(&body.mesh, v3_mad(p, n, f * document->scene->height)));
        }
        if (worst > e * 1.02) fail_msg("%g mm, error=%g", worst, e); /* between samples */
        wr_free(copy);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* A fin on an edge of a box: three triangles meet there. Open sides of the result lie on the fin's border only: no vertex
   inside a side. */
static void an_edge_of_three_faces_has_no_gap(void **state)
{
    (void)state;
    WrExportReport report;
    WrDocument *document = document_of(5, 7, 0.5, WR_WRAP_PERIODIC);
    Quads *q = new_quads();
    add_box(q, 2.3);
    add_quad(q, (WrVec3){ box[0] / 2, -box[1] / 2, box[2] / 2 }, (WrVec3){ 0.7, 0, 0 },
             (WrVec3){ 0, box[1], 0 }, 2.3);
    set_mesh(document, q, 0);
    Body body = export_body(document, "ply", "error=0.01", &report);
    const WrMesh *mesh = &body.mesh;
    const int32_t count = 3 * mesh->triangle_count;
    int64_t *sides = wr_alloc((size_t)count, sizeof *sides);
    int open = 0, triple = 0;
    for (int32_t i = 0; i < count; i++) {
        const int64_t a = mesh->corners[i / 3][i % 3], b = mesh->corners[i / 3][(i + 1) % 3];
        sides[i] = a < b ? a << 32 | b : b << 32 | a;
    }
    qsort(sides, (size_t)count, sizeof *sides, by_value);
    for (int32_t i = 0, end; i < count; i = end) {
        for (end = i + 1; end < count && sides[end] == sides[i];) end++;
        triple += end - i == 3;
        open += end - i == 1;
        for (int k = 0; k < 2 && end - i == 1; k++) {
            const float *p = mesh->points[k ? sides[i] >> 32 : sides[i] & 0xffffffff];
            if (fabs(fabs((double)p[1]) - box[1] / 2) > 1e-5 &&
                fabs((double)p[0] - box[0] / 2 - 0.7) > 1e-5 && (double)p[0] > box[0] / 2 + 0.1)
                fail_msg("open at %g,%g,%g", (double)p[0], (double)p[1], (double)p[2]);
        }
    }
    assert_true(open > 20 && triple > 10 && report.solid_open);
    wr_free(sides);
    wr_mesh_fini(&body.mesh);
    wr_document_free(document);
}

/* In an inner corner relief runs through itself: counted, with a place, or lowered until it does not. */
static void relief_in_an_inner_corner_folds(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrExportReport report;
        WrDocument *document = document_of(9, 5, 0.5, WR_WRAP_PERIODIC);
        Quads *q = new_quads();
        add_quad(q, (WrVec3){ 0, 0, 0 }, (WrVec3){ 1.3, 0, 0 }, (WrVec3){ 0, 0.9, 0 }, 2.1);
        add_quad(q, (WrVec3){ 0, 0, 0 }, (WrVec3){ 0, 0.9, 0 }, (WrVec3){ 0, 0, 1.7 }, 2.1);
        set_mesh(document, q, 0);
        document->scene->height = 0.7;
        random_state = (TestRandom){ 5 };
        Body body =
            export_body(document, "ply", k ? "error=0.01 folds=limit" : "error=0.01", &report);
        if (k == 0) assert_true(report.solid_folds > 5 && report.solid_limited == 0);
        else assert_true(report.solid_folds == 0 && report.solid_limited > 5);
        if (k == 0) assert_true(fabs(report.solid_fold[1]) < 0.91 && report.solid_fold[0] < 0.7);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* A slab 0.1 thick with relief 0.07 deep on both sides: every point is counted, or lowered until the sides are apart. */
static void relief_stays_within_its_wall(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        WrExportReport report;
        WrDocument *document = document_of(5, 3, 0, WR_WRAP_PERIODIC);
        Quads *q = new_quads();
        add_quad(q, (WrVec3){ 0, 0, 0 }, (WrVec3){ 1.3, 0, 0 }, (WrVec3){ 0, 0.9, 0 }, 0.7);
        add_quad(q, (WrVec3){ 0, 0, -0.1 }, (WrVec3){ 0, 0.9, 0 }, (WrVec3){ 1.3, 0, 0 }, 0.7);
        set_mesh(document, q, 0);
        document->scene->height *= -0.07 / height_of(document);
        Body body =
            export_body(document, "ply", k ? "error=0.01 folds=limit" : "error=0.01", &report);
        assert_int_equal(k ? report.solid_limited : report.solid_thin, 8);
        assert_int_equal(k ? report.solid_thin : report.solid_limited, 0);
        if (k == 0)
            assert_near(report.solid_size[2], 0.04, 1e-6); /* the sides have changed places */
        else assert_near(report.solid_size[2], 0.1 - 2 * 0.9 * 0.05, 1e-6);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* The same triangles as the STL file, in metres. Normals of points on a sphere are the sphere's, also about the thin triangles of
   its poles; at an edge of a sheet each side has its own. */
static void a_gltf_has_the_relief_as_geometry(void **state)
{
    (void)state;
    WrExportReport report;
    WrError err = { "" };
    const char *settings = "size=37.9 error=0.021";
    for (int k = 0; k < 3; k++) { /* a smooth sphere, a rough one, a sheet */
        WrDocument *document =
            document_of(k ? 26 : 131, k ? 17 : 97, k == 1 ? 0.31 : 0, WR_WRAP_PERIODIC);
        if (k < 2) set_surface(document, WR_SURFACE_sphere);
        document->scene->replicate_u = 3;
        Body stl = export_body(document, "stl", settings, &report);
        if (!try_export(document, "gltf", settings, "body.glb", &report, &err))
            fail_msg("%s", err.text);
        WrMesh mesh = read_whole("body.glb");
        assert_int_equal(mesh.triangle_count, stl.mesh.triangle_count);
        assert_near(1e9 * volume_of(&mesh), stl.volume, 1e-5 * stl.volume);
        int edges = 0;
        for (int32_t t = 0; t < mesh.triangle_count; t++)
            for (int c = 0; c < 3; c++) {
                const int32_t at = mesh.corners[t][c];
                const WrVec3 p = point_of(&mesh, at);
                const WrVec3 n = { mesh.normals[at][0], mesh.normals[at][1], mesh.normals[at][2] };
                const WrVec3 q = v3_scale(point_of(&stl.mesh, stl.mesh.corners[t][c]), 1e-3);
                assert_near(v3_len(v3_sub(p, q)), 0, 1e-8);
                assert_near(v3_len(n), 1, 1e-6);
                if (k == 0 && v3_dot(n, v3_unit(p, n)) < 0.99999)
                    fail_msg("a normal is %g off", v3_dot(n, v3_unit(p, n)));
                if (k == 2) edges += fabs(n.x) + fabs(n.y) + fabs(n.z) > 1 + 1e-6;
            }
        assert_int_equal(edges, 0);
        wr_mesh_fini(&mesh);
        wr_mesh_fini(&stl.mesh);
        wr_document_free(document);
    }
}

/* ---- masks and blended planes ---- */

static void project_mesh(WrDocument *document, const WrProjection *projection)
{
    WrError err = { "" };
    if (!wr_scene_project(document->scene, projection, &err)) fail_msg("%s", err.text);
}

/* The box's top alone moves up; its sides follow in their planes. */
static void a_masked_box_grows_upwards(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        WrExportReport report;
        WrDocument *document = document_of(7, 11, 0, WR_WRAP_PERIODIC);
        Quads *q = new_quads();
        WrProjection p = wr_projection_default;
        add_box(q, 3.7);
        set_mesh(document, q, 0);
        if (k == 2) p.kind = WR_PROJECTION_BOX, p.cell[0] = p.cell[1] = 0.37, p.blend = 0.3;
        p.facing = WR_FACING_Z, p.facing_soft_deg = k == 1 ? 40 : 0;
        project_mesh(document, &p);
        const double volume = box[0] * box[1] * (box[2] + height_of(document));
        Body body = export_body(document, "stl", "error=0.003", &report);
        assert_int_equal(check_closed(&body.mesh, "box"), 2);
        assert_near(body.volume, volume, 2e-6 * volume);
        assert_near(report.solid_size[0], box[0], 1e-5);
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

/* A mask of fewer and of more texels than the table. */
static void set_mask(WrDocument *document, int width, int height)
{
    WrError err = { "" };
    WrField *mask = wr_field_new(width, height, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, &err);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(mask, i, j, (float)(3 * test_random(&random_state) - 1.5));
    wr_scene_set_mask(document->scene, "mask", mask, 1);
    wr_field_free(mask);
}

/* Half of a torus; a soft belt; whole triangles that look down; mask tables: closed, on the mesh where the mask ends, and elsewhere
   within the error of the exact surface, away from the step at a hard border. */
static void masked_relief_ends_at_its_border(void **state)
{
    (void)state;
    for (int k = 0; k < 6; k++) {
        WrExportReport report;
        WrDocument *document = document_of(13, 9, 0.6, WR_WRAP_PERIODIC);
        Quads *q = new_quads();
        WrProjection p = { .cell = { 1.371, 2.113 }, .crease_deg = 180, .facing_deg = 50 };
        const double e = 0.0087, deep = document->scene->height;
        int inside = 0, outside = 0;
        add_torus(q);
        set_mesh(document, q, 0);
        p.kind = k == 1 || k == 3 ? WR_PROJECTION_BOX : WR_PROJECTION_UV;
        if (k == 0) strcpy(p.materials, "two");
        if (k == 1) p.facing = WR_FACING_OUT, p.facing_soft_deg = 47.7, p.blend = 0.41;
        if (k == 2) p.facing = WR_FACING_MINUS_Z;
        if (k == 3) p.blend = 0.77;
        if (k == 4) set_mask(document, 5, 4), p.kind = WR_PROJECTION_CYLINDRICAL;
        if (k == 5) set_mask(document, 83, 61);
        project_mesh(document, &p);
        const WrTriangles *mesh = document->scene->triangles;
        Body body = export_body(document, "stl", "error=0.0087", &report);
        assert_int_equal(check_closed(&body.mesh, "torus"), 0);
        assert_true(report.solid_error <= e && report.solid_error > 0.5 * e);
        for (int i = test_amount(0, 2800); i < 3000; i++) {
            const int32_t t = (int32_t)(test_random(&random_state) * mesh->triangle_count);
            double b = test_random(&random_state), c = test_random(&random_state), f = 0;
            if (b + c > 1) b = 1 - b, c = 1 - c;
            const double weight[3] = { 1 - b - c, b, c };
            WrVec3 place = { 0, 0, 0 }, n = place;
            for (int m = 0; m < 3; m++) {
                const WrTriangleCorner *at = &mesh->corners[mesh->triangles[t].corner[m]];
                place = v3_mad(place, (WrVec3){ at->p[0], at->p[1], at->p[2] }, weight[m]);
                n = v3_mad(n, (WrVec3){ at->n[0], at->n[1], at->n[2] }, weight[m]);
            }
            WrReliefTap taps[WR_RELIEF_TAPS];
            const int count = wr_relief_taps(mesh, t, b, c, taps);
            for (int m = 0; m < count; m++)
                f += taps[m].weight * bilinear(document->layers[0].heights, taps[m].u, taps[m].v) *
                     deep;
            const bool hard = k == 0 || k == 2;
            if (hard && fmin(weight[0], fmin(b, c)) < 0.1) continue;
            const double away = distance(&body.mesh, v3_mad(place, v3_unit(n, n), f));
            /* the bound is measured at the mask's texels; where it is cut off at 0 or 1 between two of them, the
               relief has a kink that is not measured */
            const double bound = k == 5 ? 1.6 * e : 1.02 * e;
            if (away > (hard && count == 0 ? 1e-6 : bound))
                fail_msg("case %d: %g mm, error=%g, %d terms", k, away, e, count);
            inside += count > 0, outside += count == 0;
        }
        assert_true(inside > test_amount(300, 20) && (outside > test_amount(300, 20)) == (k != 3));
        wr_mesh_fini(&body.mesh);
        wr_document_free(document);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_flat_plane_is_a_box),
        cmocka_unit_test(hc155_the_smallest_tables_are_closed_too),
        cmocka_unit_test(smooth_bodies_have_the_volumes_of_their_formulas),
        cmocka_unit_test(every_surface_is_closed),
        cmocka_unit_test(bodies_have_coordinates_of_their_cells),
        cmocka_unit_test(coordinates_do_not_jump_at_a_seam),
        cmocka_unit_test(a_model_has_the_slopes_of_its_cells),
        cmocka_unit_test(every_surface_is_a_model),
        cmocka_unit_test(held_triangles_are_a_model),
        cmocka_unit_test(a_gltf_has_the_relief_as_geometry),
        cmocka_unit_test(no_texel_is_farther_off_than_was_asked),
        cmocka_unit_test(what_cannot_be_made_is_told),
        cmocka_unit_test(an_stl_says_millimetres),
        cmocka_unit_test(a_box_grows_on_all_sides),
        cmocka_unit_test(relief_on_a_mesh_keeps_to_the_error),
        cmocka_unit_test(a_masked_box_grows_upwards),
        cmocka_unit_test(masked_relief_ends_at_its_border),
        cmocka_unit_test(an_edge_of_three_faces_has_no_gap),
        cmocka_unit_test(relief_in_an_inner_corner_folds),
        cmocka_unit_test(relief_stays_within_its_wall),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
