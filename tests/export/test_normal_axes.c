/* Normal maps with other axes, strengths, and along the object's axes: compared with the formulas; and their
   labels. */
#include "test.h"
#include "field/scheme_list.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/pool.h"
#include "document/document.h"
#include "export/export.h"
#include "export/preview.h"
#include "field/analytic.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"
#include "surface/triangles.h"

#define WIDTH 37
#define HEIGHT 22
#define TAU 6.283185307179586

static WrDocument *new_document(void)
{
    TestRandom random = { 77 };
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(WIDTH, HEIGHT, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++)
            wr_field_set(field, i, j, (float)(0.3 * test_random(&random)));
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    WrScene *scene = wr_scene_clone(document->scene);
    wr_scene_free(document->scene);
    document->scene = scene;
    scene->height = 0.37;
    return document;
}

/* Export with up to three settings, and read it back. */
static WrImage *exported(const WrDocument *document, const char *kind, const char *path,
                         const char *const settings[3], WrExportReport *report)
{
    WrError err = { "" };
    const WrExportKind *row = wr_export_find(kind);
    WrExportOptions options = wr_export_default();
    assert_non_null(row);
    for (int i = 0; i < 3 && settings[i]; i++) {
        char name[24] = "";
        const char *value = strchr(settings[i], '=') + 1;
        memcpy(name, settings[i], (size_t)(value - 1 - settings[i]));
        if (!wr_export_option(row, &options, name, value, &err)) fail_msg("%s", err.text);
    }
    if (!wr_export(row, document, &options, NULL, path, report, &err)) fail_msg("%s", err.text);
    assert_true(report->seen);
    WrImage *image = wr_image_read(path, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

static void any_order_and_signs_are_what_the_channels_hold(void **state)
{
    (void)state;
    static const struct {
        const char *kind, *axes;
        int axis[3]; /* from 1, with its sign */
        WrLabelKind label;
    } known[] = { { "normal+y", "axes=+x+y+z", { 1, 2, 3 }, WR_LABEL_NORMAL_UP },
                  { "normal-y", "axes=opengl", { 1, 2, 3 }, WR_LABEL_NORMAL_UP },
                  { "normal+y", "axes=directx", { 1, -2, 3 }, WR_LABEL_NORMAL_DOWN },
                  { "normal-y", "axes=-x+z-y", { -1, 3, -2 }, WR_LABEL_NONE },
                  { "normal+y", "axes=+z-x+y", { 3, -1, 2 }, WR_LABEL_NONE },
                  { "normal+y", "axes=+y+x+z", { 2, 1, 3 }, WR_LABEL_NONE },
                  { "normal+y", "axes=-x-y-z", { -1, -2, -3 }, WR_LABEL_NONE } };
    static const struct {
        const char *depth, *path;
        double last;
    } files[] = { { "depth=8", "n.png", 255 },
                  { "depth=16", "n.png", 65535 },
                  { "depth=32", "n.exr", 0 } };
    static const char *const schemes[] = { "scheme=bilinear", "scheme=bspline-fit",
                                           "scheme=catmull" };
    WrDocument *document = new_document();
    WrExportReport report;
    for (int s = 0; s < 3; s++) {
        WrImage *plain =
            exported(document, "normal+y", "plain.exr", (const char *[3]){ schemes[s] }, &report);
        for (size_t k = 0; k < sizeof known / sizeof *known; k++)
            for (int f = 0; f < 3; f++) {
                WrImage *image = exported(
                    document, known[k].kind, files[f].path,
                    (const char *[3]){ known[k].axes, files[f].depth, schemes[s] }, &report);
                assert_int_equal(image->label.kind, known[k].label);
                for (int t = 0; t < WIDTH * HEIGHT; t++)
                    for (int c = 0; c < 3; c++) {
                        const int axis = known[k].axis[c];
                        const double n = 2.0 * plain->data[3 * t + abs(axis) - 1] - 1.0;
                        const double want = (axis < 0 ? -n : n) / 2.0 + 0.5;
                        const double bound = files[f].last > 0 ? 0.5 / files[f].last + 1e-6 : 3e-7;
                        assert_near(image->data[3 * t + c], want, bound);
                    }
                wr_image_free(image);
            }
        wr_image_free(plain);
    }
    wr_document_free(document);
}

static void strength_multiplies_slopes(void **state)
{
    (void)state;
    WrDocument *document = new_document();
    WrExportReport report;
    WrImage *once =
        exported(document, "normal+y", "once.exr", (const char *[3]){ "cell=2,0.5" }, &report);
    WrImage *more = exported(document, "normal-y", "more.exr",
                             (const char *[3]){ "cell=2,0.5", "strength=-2.75" }, &report);
    for (int t = 0; t < WIDTH * HEIGHT; t++) {
        const float *a = once->data + 3 * t, *b = more->data + 3 * t;
        const double az = 2.0 * a[2] - 1, bz = 2.0 * b[2] - 1;
        const double p = (2.0 * a[0] - 1) / az, q = (2.0 * a[1] - 1) / az; /* green up */
        /* z is rounded too */
        const double size = 1 + 4 * (fabs(p) + fabs(q)) * (fabs(p) + fabs(q));
        assert_near((2.0 * b[0] - 1) / bz, -2.75 * p, 1e-5 * size);
        assert_near((2.0 * b[1] - 1) / bz, 2.75 * q, 1e-5 * size);
    }
    assert_near(more->label.height, -2.75 * 0.37, 1e-6);
    wr_image_free(once);
    wr_image_free(more);
    wr_document_free(document);
}

/* ---- along the object's axes ---- */

/* Blinn's N + D on a sphere of radius R with poles on z, from its longitude and latitude alone. */
static void bumped(double u, double v, double fu, double fv, double radius, double n[3])
{
    const double a = TAU * u, b = TAU / 2 * (v - 0.5);
    const double east[3] = { -sin(a), cos(a), 0 };
    const double north[3] = { -sin(b) * cos(a), -sin(b) * sin(a), cos(b) };
    const double out[3] = { cos(b) * cos(a), cos(b) * sin(a), sin(b) };
    /* slopes along unit vectors: a full turn is 2 pi R cos(b) long, from pole to pole it is pi R */
    const double p = fu / (TAU * radius * cos(b)), q = fv / (TAU / 2 * radius);
    const double length = sqrt(1 + p * p + q * q);
    for (int c = 0; c < 3; c++) n[c] = (out[c] - p * east[c] - q * north[c]) / length;
}

static void on_a_sphere_it_is_blinns_normal(void **state)
{
    (void)state;
    WrDocument *document = new_document();
    WrScene *scene = document->scene;
    WrExportReport report;
    wr_shape_default(WR_SURFACE_sphere, &scene->shape);
    scene->shape.value[0] = 1.7;
    scene->bump = WR_BUMP_BLINN;
    scene->scheme = WR_SCHEME_CENTRAL;
    const struct {
        const char *axes;
        int axis[3];
    } known[] = { { "axes=+x+y+z", { 1, 2, 3 } }, { "axes=+x+z-y", { 1, 3, -2 } } };
    const WrField *field = wr_document_field(document);
    for (int k = 0; k < 2; k++) {
        WrImage *image = exported(document, "normal-object", "o.png",
                                  (const char *[3]){ known[k].axes }, &report);
        assert_true(image->type == WR_PIXEL_U16 && image->label.kind == WR_LABEL_NONE);
        double worst = 0;
        for (int j = 0; j < HEIGHT; j++)
            for (int i = 0; i < WIDTH; i++) {
                const double east = wr_field_get(field, (i + 1) % WIDTH, j),
                             west = wr_field_get(field, (i + WIDTH - 1) % WIDTH, j);
                const double below = wr_field_get(field, i, (j + 1) % HEIGHT),
                             above = wr_field_get(field, i, (j + HEIGHT - 1) % HEIGHT);
                double n[3];
                bumped((i + 0.5) / WIDTH, 1 - (j + 0.5) / HEIGHT, 0.37 * WIDTH * (east - west) / 2,
                       0.37 * HEIGHT * (above - below) / 2, 1.7, n);
                for (int c = 0; c < 3; c++) {
                    const int axis = known[k].axis[c];
                    const double want = axis < 0 ? -n[-axis - 1] : n[axis - 1];
                    worst =
                        fmax(worst, fabs(image->data[3 * (j * WIDTH + i) + c] - (want / 2 + 0.5)));
                }
            }
        assert_near(worst, 0, 0.5 / 65535 + 1e-7);
        wr_image_free(image);
    }
    wr_document_free(document);
}

/* ---- baked for a mesh ---- */

static void set_mesh(WrScene *scene, const float (*points)[3], const float (*uv)[2],
                     int points_count, const int32_t (*corners)[3], int count)
{
    WrError err = { "" };
    const WrTrianglesSource source = { .points = points,
                                       .uv = uv,
                                       .corners = corners,
                                       .point_count = points_count,
                                       .triangle_count = count };
    WrTriangles *mesh = wr_triangles_new(&source, &err);
    if (!mesh) fail_msg("%s", err.text);
    wr_shape_default(WR_SURFACE_mesh, &scene->shape);
    wr_scene_set_triangles(scene, mesh, "", NULL);
    scene->bump = WR_BUMP_BLINN;
    scene->scheme = WR_SCHEME_CENTRAL;
}

/* Two triangles with the same (u,v), one mirrored: by MikkTSpace T is -x and x, and the map equals the cell's own in
   both. */
static void mirrored_parts_have_the_cells_own_map(void **state)
{
    (void)state;
    static const float points[4][3] = { { -1, 0, 0 }, { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 } };
    static const float uv[4][2] = { { 1, 0 }, { 0, 0 }, { 0, 1 }, { 1, 0 } };
    static const int32_t corners[2][3] = { { 0, 1, 2 }, { 1, 3, 2 } };
    WrExportReport report;
    for (int k = 0; k < 3; k++) { /* the mirrored one, the other, both */
        WrDocument *document = new_document();
        set_mesh(document->scene, points, uv, 4, corners + (k == 1), k == 2 ? 2 : 1);
        WrImage *cell = exported(document, "normal+y", "cell.exr",
                                 (const char *[3]){ "scheme=central" }, &report);
        WrImage *baked = exported(document, "normal-baked", "baked.exr",
                                  (const char *[3]){ "padding=0" }, &report);
        int inside = 0;
        for (int j = 0; j < HEIGHT; j++)
            for (int i = 0; i < WIDTH; i++) {
                const double u = (i + 0.5) / WIDTH, v = 1 - (j + 0.5) / HEIGHT;
                const float *a = cell->data + 3 * (j * WIDTH + i),
                            *b = baked->data + 3 * (j * WIDTH + i);
                inside += u + v < 1;
                for (int c = 0; c < 3; c++)
                    assert_near(b[c], u + v < 1 ? a[c] : c == 2 ? 1.0f : 0.5f, 3e-7);
            }
        assert_true(inside > WIDTH * HEIGHT / 3);
        wr_image_free(cell);
        wr_image_free(baked);
        wr_document_free(document);
    }
}

/* u = 1/2 + x/2 - y/2, v = x/2 + y: T is along grad v x n of the solution, B is n x T, and the map contains them. */
static void a_sheared_mesh_has_the_frame_of_mikktspace(void **state)
{
    (void)state;
    static const float points[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    static const float uv[3][2] = { { 0.5f, 0 }, { 1, 0.5f }, { 0, 1 } };
    static const int32_t corners[1][3] = { { 0, 1, 2 } };
    const double t[2] = { 0.894427190999916, -0.447213595499958 }, b[2] = { -t[1], t[0] };
    WrExportReport report;
    WrDocument *document = new_document();
    set_mesh(document->scene, points, uv, 3, corners, 1);
    const WrField *field = wr_document_field(document);
    WrImage *baked = exported(document, "normal-baked", "b.png",
                              (const char *[3]){ "axes=directx", "padding=0" }, &report);
    int inside = 0;
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) {
            const double u = (i + 0.5) / WIDTH - 0.5, v = 1 - (j + 0.5) / HEIGHT;
            const double x = (u + v / 2) / 0.75,
                         y = v - x / 2; /* the inverse of the two lines above */
            const float *have = baked->data + 3 * (j * WIDTH + i);
            if (x < 1e-6 || y < 1e-6 || x + y > 1 - 1e-6) continue;
            const double fu = 0.37 * WIDTH *
                              (wr_field_get(field, (i + 1) % WIDTH, j) -
                               wr_field_get(field, (i + WIDTH - 1) % WIDTH, j)) /
                              2;
            const double fv = 0.37 * HEIGHT *
                              (wr_field_get(field, i, (j + HEIGHT - 1) % HEIGHT) -
                               wr_field_get(field, i, (j + 1) % HEIGHT)) /
                              2;
            const double g[2] = { fu * 0.5 + fv * 0.5, fu * -0.5 + fv };
            const double length = sqrt(1 + g[0] * g[0] + g[1] * g[1]);
            assert_near(have[0], 0.5 - (g[0] * t[0] + g[1] * t[1]) / length / 2,
                        0.5 / 65535 + 1e-6);
            assert_near(have[1], 0.5 + (g[0] * b[0] + g[1] * b[1]) / length / 2,
                        0.5 / 65535 + 1e-6);
            assert_near(have[2], 0.5 + 1 / length / 2, 0.5 / 65535 + 1e-6);
            inside++;
        }
    assert_true(inside > WIDTH * HEIGHT / 4);
    assert_int_equal(baked->label.kind, WR_LABEL_NONE); /* it belongs to no cell */
    assert_int_equal(baked->label.green, -1);
    assert_string_equal(baked->label.refused, "");
    wr_image_free(baked);
    baked = exported(document, "normal-baked", "b.exr", (const char *[3]){ "padding=0" }, &report);
    assert_int_equal(baked->label.green, 1);
    wr_image_free(baked);
    baked =
        exported(document, "normal-baked", "b.exr", (const char *[3]){ "axes=+x-z+y" }, &report);
    assert_int_equal(baked->label.green, 0);
    wr_image_free(baked);
    wr_document_free(document);
}

/* Three texels for each of the table's: every third centre is one of the table's and has its normal. */
static void maps_have_any_size(void **state)
{
    (void)state;
    static const float points[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    static const float uv[3][2] = { { 0.1f, 0.1f }, { 0.9f, 0.2f }, { 0.2f, 0.8f } };
    static const int32_t corners[1][3] = { { 0, 1, 2 } };
    static const char *const kinds[] = { "normal-object", "normal-baked" };
    char size[32];
    WrExportReport report;
    WrDocument *document = new_document();
    snprintf(size, sizeof size, "size=%dx%d", 3 * WIDTH, 3 * HEIGHT);
    for (int k = 0; k < 2; k++) {
        if (k == 1) set_mesh(document->scene, points, uv, 3, corners, 1);
        else wr_shape_default(WR_SURFACE_sphere, &document->scene->shape);
        const char *padding = k == 1 ? "padding=0" : NULL;
        WrImage *own =
            exported(document, kinds[k], "own.exr", (const char *[3]){ padding }, &report);
        WrImage *large =
            exported(document, kinds[k], "large.exr", (const char *[3]){ size, padding }, &report);
        assert_int_equal(report.width, 3 * WIDTH);
        assert_int_equal(large->width, 3 * WIDTH);
        assert_int_equal(large->height, 3 * HEIGHT);
        int bumped_texels = 0;
        for (int j = 0; j < HEIGHT; j++)
            for (int i = 0; i < WIDTH; i++)
                for (int c = 0; c < 3; c++) {
                    const float a = own->data[3 * (j * WIDTH + i) + c];
                    assert_near(large->data[3 * ((3 * j + 1) * 3 * WIDTH + 3 * i + 1) + c], a,
                                1e-6);
                    bumped_texels += c == 0 && a != 0.5f;
                }
        assert_true(bumped_texels > WIDTH * HEIGHT / 5);
        wr_image_free(own);
        wr_image_free(large);
        WrImage *small = exported(document, kinds[k], "small.png",
                                  (const char *[3]){ "size=5x1", padding }, &report);
        assert_int_equal(small->width * small->height, 5);
        wr_image_free(small);
    }
    wr_document_free(document);
}

/* An island gets rings around it, across the map's edge too, and nothing beyond. */
static void padding_goes_as_far_as_it_is_told(void **state)
{
    (void)state;
    static const float points[3][3] = { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } };
    static const float uv[3][2] = { { 0.9f, 0.4f }, { 1.15f, 0.4f }, { 0.9f, 0.6f } };
    static const int32_t corners[1][3] = { { 0, 1, 2 } };
    WrExportReport report;
    WrDocument *document = new_document();
    set_mesh(document->scene, points, uv, 3, corners, 1);
    WrImage *bare =
        exported(document, "normal-baked", "p.exr", (const char *[3]){ "padding=0" }, &report);
    WrImage *padded =
        exported(document, "normal-baked", "p.exr", (const char *[3]){ "padding=3" }, &report);
    int places = 0, rings = 0;
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) {
            /* distance in rings to a covered texel; none of the random heights is level */
            int nearest = 99;
            for (int y = 0; y < HEIGHT; y++)
                for (int x = 0; x < WIDTH; x++) {
                    const float *n = bare->data + 3 * (y * WIDTH + x);
                    if (n[0] == 0.5f && n[1] == 0.5f) continue;
                    int dx = abs(x - i), dy = abs(y - j);
                    dx = dx > WIDTH / 2 ? WIDTH - dx : dx, dy = dy > HEIGHT / 2 ? HEIGHT - dy : dy;
                    nearest = dx > dy ? (dx < nearest ? dx : nearest) : dy < nearest ? dy : nearest;
                }
            const float *have = padded->data + 3 * (j * WIDTH + i),
                        *was = bare->data + 3 * (j * WIDTH + i);
            if (nearest == 0 || nearest > 3) assert_memory_equal(have, was, 3 * sizeof *have);
            else assert_true(have[0] != 0.5f || have[1] != 0.5f);
            const double n[3] = { 2.0 * have[0] - 1, 2.0 * have[1] - 1, 2.0 * have[2] - 1 };
            assert_near(n[0] * n[0] + n[1] * n[1] + n[2] * n[2], 1, 1e-6);
            places += nearest == 0, rings += nearest > 0 && nearest <= 3;
        }
    assert_true(places > 10 && rings > 40);
    wr_image_free(bare);
    wr_image_free(padded);
    wr_document_free(document);
}

static void surfaces_without_one_chart_are_refused(void **state)
{
    (void)state;
    WrDocument *document = new_document();
    WrExportOptions options = wr_export_default();
    WrError err = { "" };
    wr_shape_default(WR_SURFACE_cube, &document->scene->shape);
    assert_false(
        wr_export(wr_export_find("normal-object"), document, &options, NULL, "c.png", NULL, &err));
    assert_non_null(strstr(err.text, "surface cube"));
    assert_false(
        wr_export(wr_export_find("normal-baked"), document, &options, NULL, "c.png", NULL, &err));
    assert_non_null(strstr(err.text, "baked for a mesh"));
    static const char *const bad[] = { "",    "+x",     "+x+y",   "+x+y+z+", "+x+x+z",
                                       "xyz", "+x+y+w", "OpenGL", "+x+y z" };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        assert_false(wr_export_option(wr_export_find("normal+y"), &options, "axes", bad[i], &err));
        assert_non_null(strstr(err.text, "opengl, directx"));
    }
    static const char *const weak[] = { "0", "nan", "1e7", "", "x" };
    for (size_t i = 0; i < sizeof weak / sizeof *weak; i++)
        assert_false(
            wr_export_option(wr_export_find("normal-y"), &options, "strength", weak[i], &err));
    wr_document_free(document);
}

/* ---- a table of several runs and tiles in memory ---- */

/* The height at an index at most one beyond the ends. */
static double tap(const WrField *field, int i, int j)
{
    const int w = wr_field_width(field), h = wr_field_height(field);
    const bool clamps_u = wr_field_wrap_u(field) == WR_WRAP_CLAMP;
    const bool clamps_v = wr_field_wrap_v(field) == WR_WRAP_CLAMP;
    if (clamps_u && (i < 0 || i >= w)) {
        const int end = i < 0 ? 0 : w - 1, in = i < 0 ? 1 : -1;
        return (float)(3 * tap(field, end, j) - 3 * tap(field, end + in, j) +
                       tap(field, end + 2 * in, j));
    }
    if (clamps_v && (j < 0 || j >= h)) {
        const int end = j < 0 ? 0 : h - 1, in = j < 0 ? 1 : -1;
        return (float)(3 * tap(field, i, end) - 3 * tap(field, i, end + in) +
                       tap(field, i, end + 2 * in));
    }
    return (double)wr_field_get(field, (i + w) % w, (j + h) % h);
}

/* Level except for a slanted half, which has tiles. */
static WrField *half_rough(int w, int h, WrWrap wrap_u, WrWrap wrap_v)
{
    TestRandom random = { (uint64_t)w };
    WrField *field = wr_field_new(w, h, wrap_u, wrap_v, 0.171f, NULL);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++)
            if (i + j / 3 > w / 2 || j < 2)
                wr_field_set(field, i, j, (float)(0.011 * test_random(&random)));
    return field;
}

static void check_bytes(const WrDocument *document, const WrExportPreview *picture)
{
    const WrField *field = wr_document_field(document);
    const int w = wr_field_width(field), h = wr_field_height(field);
    const long double height = document->scene->height;
    assert_true(picture->width == w && picture->height == h);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) {
            const long double x = -height * w * (tap(field, i + 1, j) - tap(field, i - 1, j)) / 2;
            const long double y = height * h * (tap(field, i, j + 1) - tap(field, i, j - 1)) / 2;
            const long double length = sqrtl(x * x + y * y + 1);
            const long double n[3] = { x / length, y / length, 1 / length };
            for (int c = 0; c < 3; c++) {
                const long double code = 255 * (n[c] / 2 + 0.5L), part = code - floorl(code);
                const int got = picture->rgb[3 * ((size_t)j * (size_t)w + (size_t)i) + (size_t)c];
                if (fabsl(part - 0.5L) > 1e-9L && got != (int)floorl(code + 0.5L))
                    fail_msg("texel %d,%d channel %d: %d, want %Lg", i, j, c, got, code);
            }
        }
}

static void bytes_in_memory_are_the_formulas_for_any_ends_and_threads(void **state)
{
    (void)state;
    static const int sizes[][2] = { { 523, 211 }, { 257, 65 }, { 3, 130 }, { 320, 3 } };
    for (int k = 0; k < 8; k++) {
        const WrExportOptions options = wr_export_default();
        WrDocument *document = new_document();
        wr_field_free(document->layers[0].heights);
        document->layers[0].heights =
            half_rough(sizes[k % 4][0], sizes[k % 4][1], k & 4 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC,
                       k & 1 ? WR_WRAP_CLAMP : WR_WRAP_PERIODIC);
        WrPool *pool = wr_pool_new(3);
        WrExportPreview one, three;
        const WrExportKind *kind = wr_export_find("normal+y");
        assert_true(wr_export_preview(kind, document, &options, NULL, &one, NULL));
        assert_true(wr_export_preview(kind, document, &options, pool, &three, NULL));
        check_bytes(document, &one);
        assert_memory_equal(one.rgb, three.rgb, (size_t)one.width * (size_t)one.height * 3);
        wr_export_preview_fini(&one);
        wr_export_preview_fini(&three);
        wr_pool_free(pool);
        wr_document_free(document);
    }
}

/* Grey values of the map's codes, with any number of threads: as in the file. */
static void a_picture_of_one_channel_is_grey_as_its_file(void **state)
{
    (void)state;
    static const char *const kinds[] = { "curvature", "cavity", "height" };
    WrDocument *document = new_document();
    WrPool *pool = wr_pool_new(3);
    for (int k = 0; k < 3; k++) {
        WrExportReport report;
        WrExportPreview picture;
        const char *const settings[3] = { "depth=8", NULL };
        const WrExportOptions options = wr_export_default();
        WrImage *file = exported(document, kinds[k], "grey.png", settings, &report);
        assert_true(
            wr_export_preview(wr_export_find(kinds[k]), document, &options, pool, &picture, NULL));
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            for (int c = 0; c < 3; c++)
                assert_int_equal(picture.rgb[3 * i + c],
                                 lrint(255 * (double)file->data[i * file->channels]));
        wr_export_preview_fini(&picture);
        wr_image_free(file);
    }
    wr_pool_free(pool);
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_order_and_signs_are_what_the_channels_hold),
        cmocka_unit_test(strength_multiplies_slopes),
        cmocka_unit_test(on_a_sphere_it_is_blinns_normal),
        cmocka_unit_test(surfaces_without_one_chart_are_refused),
        cmocka_unit_test(mirrored_parts_have_the_cells_own_map),
        cmocka_unit_test(a_sheared_mesh_has_the_frame_of_mikktspace),
        cmocka_unit_test(maps_have_any_size),
        cmocka_unit_test(padding_goes_as_far_as_it_is_told),
        cmocka_unit_test(bytes_in_memory_are_the_formulas_for_any_ends_and_threads),
        cmocka_unit_test(a_picture_of_one_channel_is_grey_as_its_file),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
