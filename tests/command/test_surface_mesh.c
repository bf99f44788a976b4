/* `surface mesh file=`: notes of a session, storage in both kinds of documents, and an error for a file whose content
   has changed. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "command/session.h"
#include "document/document.h"
#include "field/field.h"
#include "image/image.h"
#include "image/mesh.h"
#include "scene/objects.h"
#include "scene/scene.h"
#include "surface/patches.h"
#include "surface/relief_weights.h"
#include "surface/triangles.h"

#include <sys/stat.h>
#include <unistd.h>

static void note(void *ctx, const char *text)
{
    wr_text_addf(ctx, "%s\n", text);
}

static WrSession *session_with(WrText *notes)
{
    const WrSessionOptions options = { .note = note, .note_ctx = notes, .outputs = true };
    return wr_session_new(&options);
}

static void write_file(const char *path, const char *text)
{
    WrError err;
    if (!wr_file_write(path, text, strlen(text), &err)) fail_msg("%s", err.text);
}

static const char roof[] = "v 0 0 0\nv 1 0 1\nv 1 2 1\nv 0 2 0\nv 2 0 0\nv 2 2 0\n"
                           "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                           "f 1/1 2/2 3/3 4/4\nf 2/1 5/2 6/3 3/4\n";

static const WrScene *scene_in(const WrSession *session)
{
    return wr_session_document(session)->scene;
}

static void a_mesh_is_told_of_and_undone(void **state)
{
    (void)state;
    WrText notes = { 0 };
    write_file("roof.obj", roof);
    WrSession *s = session_with(&notes);
    must_run(s, "surface mesh file=roof.obj");
    const WrTriangles *mesh = scene_in(s)->triangles;
    assert_int_equal(mesh->triangle_count, 4);
    assert_non_null(strstr(wr_text_get(&notes), "roof.obj: 4 triangles, open"));
    assert_non_null(strstr(wr_text_get(&notes), "100.0% of its texture coordinates are met twice"));
    assert_non_null(strstr(wr_text_get(&notes), "without a normal"));
    assert_near(wr_shape_radius(&scene_in(s)->shape), mesh->radius, 0);
    assert_near(wr_shape_centre(&scene_in(s)->shape).y, 1, 0);
    must_run(s, "undo");
    assert_null(scene_in(s)->triangles);
    assert_int_equal(scene_in(s)->shape.kind, WR_SURFACE_plane);
    must_run(s, "redo");
    assert_true(scene_in(s)->triangles == mesh);
    must_run(s, "surface torus");
    assert_null(scene_in(s)->triangles);
    must_run(s, "surface mesh"); /* the square */
    assert_null(scene_in(s)->triangles);
    assert_near(wr_shape_radius(&scene_in(s)->shape), sqrt(0.5), 1e-12);
    wr_session_free(s);
    wr_text_fini(&notes);
}

static void documents_carry_it(void **state)
{
    (void)state;
    static const char *const names[] = { "d.exr", "d.ora" };
    WrText notes = { 0 };
    WrError err = { "" };
    for (int i = 0; i < 2; i++) {
        char line[40];
        write_file("roof.obj", roof);
        WrSession *a = session_with(&notes), *b = session_with(&notes);
        must_run(a, "table 8x8");
        must_run(a, "surface mesh file=roof.obj");
        snprintf(line, sizeof line, "save %s", names[i]);
        must_run(a, line);
        assert_int_equal(unlink("roof.obj"), 0);
        if (!wr_session_open(b, names[i], &err)) fail_msg("%s", err.text);
        const WrTriangles *was = scene_in(a)->triangles, *is = scene_in(b)->triangles;
        assert_non_null(is);
        assert_true(is->key == was->key && is->triangle_count == was->triangle_count);
        assert_memory_equal(&scene_in(a)->shape, &scene_in(b)->shape, sizeof(WrShape));
        assert_string_equal(scene_in(a)->triangles_sha256, scene_in(b)->triangles_sha256);
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        wr_session_free(a);
        wr_session_free(b);
    }
    wr_text_fini(&notes);
}

/* Of several objects the one with the mesh need not be active; all different meshes are stored, each once. */
static void objects_share_one(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrError err = { "" };
    write_file("roof.obj", roof);
    write_file("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    WrSession *a = session_with(&notes), *b = session_with(&notes);
    must_run(a, "surface mesh file=roof.obj");
    must_run(a, "object add ball");
    must_run(a, "surface sphere");
    must_run(a, "save two.exr");
    assert_int_equal(unlink("roof.obj"), 0);
    if (!wr_session_open(b, "two.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    wr_session_free(b);
    write_file("roof.obj", roof);
    must_run(a, "surface mesh file=flat.obj");
    must_run(a, "object add plain");
    must_run(a, "object add again");
    must_run(a, "surface mesh file=roof.obj");
    must_run(a, "object choose ball");
    must_run(a, "save all.exr");
    must_run(a, "save all.ora");
    assert_int_equal(unlink("roof.obj") | unlink("flat.obj"), 0);
    for (int k = 0; k < 2; k++) {
        b = session_with(&notes);
        if (!wr_session_open(b, k ? "all.ora" : "all.exr", &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        for (int i = 0; i < 4; i++) {
            const WrTriangles *was = wr_scene_object(scene_in(a), i)->triangles;
            const WrTriangles *is = wr_scene_object(scene_in(b), i)->triangles;
            assert_true(i == 2 ? !was && !is : was && is && was->key == is->key);
        }
        wr_session_free(b);
    }
    wr_session_free(a);
    wr_text_fini(&notes);
}

/* A hostile picture of several meshes: an error, whatever its header contains. */
static void damaged_meshes_are_refused(void **state)
{
    (void)state;
    WrText notes = { 0 };
    write_file("roof.obj", roof);
    write_file("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    WrSession *a = session_with(&notes);
    must_run(a, "surface mesh file=roof.obj");
    must_run(a, "object add ball");
    must_run(a, "surface mesh file=flat.obj");
    const float bad[] = { -1, 0, 0.5f, 3, 64, 1e30f, 65536, 16777216 };
    WrImage *image;
    WrError err = { "" };
    assert_true(wr_scene_meshes_to_image(scene_in(a), &image, &err));
    for (int at = 0; at < 9; at++)
        for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
            const float was = image->data[at];
            image->data[at] = bad[k];
            for (int object = 0; object < 4; object++) {
                WrTriangles *made = wr_scene_mesh_from_image(image, object, &err);
                if (object > 1 && made) fail_msg("number %d as %g", at, (double)bad[k]);
                wr_triangles_free(made);
            }
            image->data[at] = was;
        }
    WrTriangles *flat = wr_scene_mesh_from_image(image, 1, &err);
    assert_true(flat && flat->triangle_count == 1);
    wr_triangles_free(flat);
    wr_image_free(image);
    wr_session_free(a);
    wr_text_fini(&notes);
}

static void another_content_is_an_error(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrError err = { "" };
    char hex[65], line[120];
    write_file("roof.obj", roof);
    assert_true(wr_sha256_file("roof.obj", hex, &err));
    WrSession *s = session_with(&notes);
    snprintf(line, sizeof line, "surface mesh file=roof.obj sha256=%s", hex);
    must_run(s, line);
    assert_string_equal(scene_in(s)->triangles_sha256, hex);
    write_file("roof.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    assert_false(wr_session_run(s, line, &err));
    assert_non_null(strstr(err.text, "file has changed"));
    assert_int_equal(scene_in(s)->triangles->triangle_count, 4); /* unchanged */
    must_run(s, "surface mesh file=roof.obj");
    assert_non_null(strstr(wr_text_get(&notes), "no texture coordinates"));
    assert_false(wr_session_run(s, "surface mesh file=nowhere.obj", &err));
    write_file("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 2\n");
    assert_false(wr_session_run(s, "surface mesh file=bad.obj", &err));
    assert_false(wr_session_run(s, "surface mesh sha256=00", &err));
    wr_session_free(s);
    wr_text_fini(&notes);
}

static const char slab[] = "2\n3 3\n0 0 0\n1 0 0\n2 0 0\n3 0 0\n0 1 0\n1 1 1\n2 1 1\n3 1 0\n"
                           "0 2 0\n1 2 1\n2 2 1\n3 2 0\n0 3 0\n1 3 0\n2 3 0\n3 3 0\n"
                           "3 3\n3 0 0\n4 0 0\n5 0 0\n6 0 0\n3 1 0\n4 1 1\n5 1 1\n6 1 0\n"
                           "3 2 0\n4 2 1\n5 2 1\n6 2 0\n3 3 0\n4 3 0\n5 3 0\n6 3 0\n";

/* The file is gone by now; the set has another table, and is in another document. */
static void another_table_without_the_file(WrSession *s)
{
    const uint64_t key = scene_in(s)->triangles->key;
    must_run(s, "surface patches table=joined");
    const WrTriangles *is = scene_in(s)->triangles;
    assert_int_equal(is->patches->table, WR_PATCH_JOINED);
    assert_int_equal(is->patches->count, 2);
    assert_string_equal(scene_in(s)->triangles_path, "slab.bpt");
    assert_int_equal(strlen(scene_in(s)->triangles_sha256), 64);
    must_run(s, "surface patches table=split");
    assert_true(scene_in(s)->triangles->key == key);
    must_run(s, "surface sphere");
    must_fail(s, "surface patches table=own", "needs file=");
}

/* Patches, and a terrain: read, reported, stored in both kinds of documents with their table. */
static void patches_and_terrains_are_kept(void **state)
{
    (void)state;
    static const char *const lines[] = { "surface patches file=slab.bpt table=split",
                                         "surface patches file=slab.bpt table=own",
                                         "surface terrain file=hills.pgm height=0.4 cells=8" };
    static const char *const names[] = { "d.exr", "d.ora" };
    WrText notes = { 0 };
    WrError err = { "" };
    for (int i = 0; i < 6; i++) {
        char line[40];
        write_file("slab.bpt", slab);
        write_file("hills.pgm", "P2\n4 3\n255\n0 80 90 10\n20 255 60 0\n5 9 130 70\n");
        WrSession *a = session_with(&notes), *b = session_with(&notes);
        must_run(a, "table 8x8");
        must_run(a, lines[i / 2]);
        const WrPatches *set = scene_in(a)->triangles->patches;
        assert_int_equal(set->columns, i / 2 == 2 ? 8 : 2);
        snprintf(line, sizeof line, "save %s", names[i % 2]);
        must_run(a, line);
        assert_int_equal(unlink("slab.bpt"), 0);
        assert_int_equal(unlink("hills.pgm"), 0);
        if (!wr_session_open(b, names[i % 2], &err)) fail_msg("%s", err.text);
        const WrTriangles *is = scene_in(b)->triangles;
        assert_non_null(is);
        assert_true(is->key == scene_in(a)->triangles->key && is->patches);
        assert_int_equal(is->patches->table, set->table);
        assert_memory_equal(&scene_in(a)->shape, &scene_in(b)->shape, sizeof(WrShape));
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        if (i / 2 == 0) another_table_without_the_file(b);
        wr_session_free(a);
        wr_session_free(b);
    }
    assert_non_null(strstr(wr_text_get(&notes), "2 patches in"));
    assert_non_null(strstr(wr_text_get(&notes), "; shared edges: 1; open edges: 6"));
    assert_non_null(strstr(wr_text_get(&notes), "8 x 8 patches in"));
    write_file("bad.bpt", "1\n3 3\n0 0 zero\n");
    WrSession *s = session_with(&notes);
    must_fail(s, "surface patches file=bad.bpt", "bad.bpt: line 3: \"zero\" is not a coordinate");
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* ---- projections ---- */

/* A cube in a text STL, whose facets are without normals. */
static void write_cube(const char *path, double side)
{
    static const int at[12][3] = { { 0, 2, 1 }, { 0, 3, 2 }, { 4, 5, 6 }, { 4, 6, 7 },
                                   { 0, 1, 5 }, { 0, 5, 4 }, { 1, 2, 6 }, { 1, 6, 5 },
                                   { 2, 3, 7 }, { 2, 7, 6 }, { 3, 0, 4 }, { 3, 4, 7 } };
    WrText text = { 0 };
    wr_text_add(&text, "solid cube\n");
    for (int i = 0; i < 12; i++) {
        wr_text_add(&text, "facet normal 0 0 0\nouter loop\n");
        for (int k = 0; k < 3; k++) {
            const int c = at[i][k];
            wr_text_addf(&text, "vertex %.7g %.7g %.7g\n", (c & 3) % 3 ? side : 0, c & 2 ? side : 0,
                         c >= 4 ? side : 0);
        }
        wr_text_add(&text, "endloop\nendfacet\n");
    }
    wr_text_add(&text, "endsolid cube\n");
    write_file(path, wr_text_get(&text));
    wr_text_fini(&text);
}

static bool same_mesh(const WrTriangles *a, const WrTriangles *b)
{
    return a->corner_count == b->corner_count && a->triangle_count == b->triangle_count &&
           memcmp(a->corners, b->corners, (size_t)a->corner_count * sizeof *a->corners) == 0 &&
           memcmp(a->triangles, b->triangles, (size_t)a->triangle_count * sizeof *a->triangles) ==
               0;
}

static void check_version(const char *path, const char *version)
{
    WrError err;
    WrImageFile *file = wr_image_file_open(path, &err);
    if (!file) fail_msg("%s", err.text);
    assert_string_equal(wr_image_file_attribute(file, 0, "wrinkle:version"), version);
    wr_image_file_close(file);
}

static const char *surface_line(const WrSession *session, WrText *scene)
{
    wr_text_fini(scene);
    wr_session_scene_text(session, scene);
    return strstr(wr_text_get(scene), "surface ");
}

/* Documents hold the file's mesh and the settings: another projection after loading is that of the file. */
static void projections_are_kept(void **state)
{
    (void)state;
    static const char *const names[] = { "d.exr", "d.ora" };
    static const char *const kinds[] = { "planar", "box", "cylindrical", "spherical", "uv" };
    WrError err = { "" };
    for (int i = 0; i < 10; i++) {
        WrText notes = { 0 }, was = { 0 }, is = { 0 };
        char line[160];
        WrSession *a = session_with(&notes), *b = session_with(&notes);
        write_cube("cube.stl", 7.3890561);
        must_run(a, "table 8x8");
        snprintf(line, sizeof line,
                 "surface mesh file=cube.stl projection=%s cell=1.5cm,0.5in turn=33.7,-71.3,128.9 "
                 "at=0.3,12.9,8.77 unit=cm crease=30",
                 kinds[i / 2]);
        must_run(a, line);
        snprintf(line, sizeof line, "save %s", names[i % 2]);
        must_run(a, line);
        assert_int_equal(unlink("cube.stl"), 0);
        if (!wr_session_open(b, names[i % 2], &err)) fail_msg("%s", err.text);
        if (i % 2 == 0) check_version("d.exr", "10");
        assert_true(same_mesh(scene_in(a)->triangles, scene_in(b)->triangles));
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        assert_string_equal(surface_line(a, &was), surface_line(b, &is));
        const char *rest = i / 2 == 4 ? " unit=cm crease=30\n"
                                      : " cell=15mm,12.7mm turn=33.7,-71.3,128.9 "
                                        "at=0.3,12.9,8.77 unit=cm crease=30\n";
        assert_non_null(strstr(wr_text_get(&is), rest));
        must_run(a, "surface mesh projection=cylindrical cell=20mm");
        must_run(b, "surface mesh projection=cylindrical cell=20mm");
        assert_true(same_mesh(scene_in(a)->triangles, scene_in(b)->triangles));
        must_run(b, "undo");
        assert_string_equal(surface_line(b, &is), strstr(wr_text_get(&was), "surface "));
        must_run(b, "redo");
        assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
        wr_session_free(a);
        wr_session_free(b);
        wr_text_fini(&notes);
        wr_text_fini(&was);
        wr_text_fini(&is);
    }
}

/* Settings that are left out stay; the file's own coordinates and normals return. */
static void a_mesh_is_projected_without_its_file(void **state)
{
    (void)state;
    WrText notes = { 0 }, text = { 0 };
    WrSession *s = session_with(&notes);
    write_cube("cube.stl", 30);
    must_run(s, "surface mesh file=cube.stl");
    WrTriangles *first = wr_triangles_share(scene_in(s)->triangles);
    assert_null(strstr(wr_text_get(&notes), "millimetres"));
    must_run(s, "save plain.exr");
    check_version("plain.exr", "4"); /* as before there were projections */
    assert_int_equal(unlink("cube.stl"), 0);
    must_run(s, "surface mesh projection=box cell=7mm crease=30");
    assert_true(scene_in(s)->triangles->faceted && scene_in(s)->triangles->mapped);
    assert_int_equal(scene_in(s)->triangles->corner_count, 24);
    assert_non_null(strstr(wr_text_get(&notes),
                           "projection=box: 12 triangles; the file's numbers are taken as "
                           "millimetres: unit= states another unit; edges that the table does "
                           "not run on across: 12, the longest run of them 360 long, at "));
    must_run(s, "surface mesh cell=14mm");
    assert_non_null(strstr(surface_line(s, &text), " projection=box cell=14mm crease=30\n"));
    must_run(s, "surface mesh unit=in");
    assert_non_null(
        strstr(surface_line(s, &text), " projection=box cell=14mm unit=in crease=30\n"));
    must_run(s, "surface mesh projection=uv crease=180");
    assert_true(same_mesh(scene_in(s)->triangles, first));
    assert_null(scene_in(s)->mesh_source);
    must_run(s, "undo 4");
    assert_true(scene_in(s)->triangles == first && !scene_in(s)->mesh_source);
    must_run(s, "redo 4");
    must_run(s, "object add other");
    must_run(s, "surface sphere");
    must_fail(s, "surface mesh cell=5mm", "settings of the projection need file=");
    wr_triangles_free(first);
    wr_session_free(s);
    wr_text_fini(&notes);
    wr_text_fini(&text);
}

/* Units that files state: those of a 3MF file are kept, glTF is in metres. */
static void units_are_the_files(void **state)
{
    (void)state;
    WrText notes = { 0 }, text = { 0 };
    WrSession *s = session_with(&notes);
    must_run(s, "surface mesh file=" WR_SOURCE_DIR
                "/tests/image/cases/box_inch.3mf projection=box cell=10mm");
    assert_non_null(strstr(surface_line(s, &text), " projection=box cell=10mm unit=in\n"));
    float most = 0;
    for (int32_t i = 0; i < scene_in(s)->triangles->corner_count; i++)
        most = fmaxf(most, fabsf(scene_in(s)->triangles->corners[i].u));
    assert_near((double)most, 25.4, 1e-4); /* 10 inches from the middle to the farthest side */
    assert_null(strstr(wr_text_get(&notes), "millimetres"));
    assert_null(strstr(wr_text_get(&notes), "no texture coordinates"));
    must_run(s, "surface mesh unit=mm");
    assert_non_null(strstr(surface_line(s, &text), " projection=box cell=10mm unit=mm\n"));
    wr_session_free(s);
    wr_text_fini(&notes);
    wr_text_fini(&text);
}

/* A mesh far from its file's origin: the scene stores the place, also in a document, and the solid stands there. */
static void a_far_mesh_returns_to_its_place(void **state)
{
    (void)state;
    WrText notes = { 0 }, text = { 0 };
    WrError err = { "" };
    WrSession *a = session_with(&notes), *b = session_with(&notes);
    write_file("far.obj",
               "v 40000 -80000 5\nv 40010 -80000 5\nv 40000 -79990 5\nv 40000 -80000 15\n"
               "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\nf 2 2 3\n");
    must_run(a, "table 8x8");
    must_run(a, "surface mesh file=far.obj projection=planar cell=3mm");
    assert_non_null(strstr(surface_line(a, &text), " origin=40000,-80000,5"));
    assert_non_null(strstr(wr_text_get(&notes), "without area, left out: 1, the first at "));
    assert_non_null(strstr(wr_text_get(&notes), ",-79996.67,5")); /* in the file's coordinates */
    must_run(a, "surface mesh projection=uv");
    must_run(a, "surface mesh projection=box");
    must_run(a, "save far.exr");
    if (!wr_session_open(b, "far.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    for (int k = 0; k < 3; k++) {
        /* of two sizes, and with an error that 32-bit coordinates there do not allow */
        static const char *const lines[] = { "export stl out.stl", "export stl out.stl size=30",
                                             "export stl out.stl error=0.005" };
        WrMesh mesh = { 0 };
        wr_text_clear(&notes);
        must_run(b, lines[k]);
        if (!wr_mesh_read("out.stl", &mesh, &err)) fail_msg("%s", err.text);
        double low = INFINITY, high = -INFINITY; /* of y */
        for (int32_t i = 0; i < mesh.point_count; i++) {
            low = fmin(low, (double)mesh.points[i][1] + mesh.origin[1]);
            high = fmax(high, (double)mesh.points[i][1] + mesh.origin[1]);
        }
        assert_near(low, k == 0 ? -80000 : k == 1 ? -15 : 0, 0.01);
        assert_near(high, k == 0 ? -79990 : k == 1 ? 15 : 10, 0.01);
        assert_int_equal(
            strstr(wr_text_get(&notes), "stands at 0,0,0 instead of 40000,-80000,5 mm") != NULL,
            k == 2);
        wr_mesh_fini(&mesh);
    }
    wr_session_free(a);
    wr_session_free(b);
    wr_text_fini(&notes);
    wr_text_fini(&text);
}

/* Notes of a mesh's faults, when it is read and when it is exported. */
static void faults_are_noted(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("fin.obj",
               "v 0 0 0\nv 10 0 0\nv 0 10 0\nv 0 0 10\nv -4 -6 5\nvt nan 0\nvt 1 0\nvt 0 1\n"
               "f 1/2 3/3 2/2\nf 1/1 2/2 4/3\nf 1/2 4/3 3/2\nf 2/2 3/2 4/3\nf 1/2 4/2 5/3\n");
    must_run(s, "table 8x8");
    must_run(s, "noise simplex");
    must_run(s, "surface mesh file=fin.obj");
    assert_non_null(strstr(wr_text_get(&notes),
                           "fin.obj: points with texture coordinates that are not "
                           "numbers, or beyond 1e6: 1, the first at 0,0,0"));
    for (int k = 0; k < 2; k++) {
        assert_non_null(strstr(wr_text_get(&notes), ", open"));
        assert_non_null(strstr(wr_text_get(&notes), "; open edges: 2, the first at "));
        assert_non_null(
            strstr(wr_text_get(&notes), "; edges of more than two faces: 1, the first at 0,0,5"));
        wr_text_clear(&notes);
        must_run(s, "surface mesh projection=box crease=40");
        assert_null(strstr(wr_text_get(&notes), "crease="));
        must_run(s, "export stl out.stl");
    }
    assert_null(strstr(wr_text_get(&notes), "object"));
    assert_null(strstr(wr_text_get(&notes), "seam")); /* of the table's edges */
    must_run(s, "surface mesh crease=180");
    assert_non_null(strstr(wr_text_get(&notes), "the file has no normals"));
    assert_non_null(strstr(wr_text_get(&notes), "crease=30"));
    char name[240], line[300]; /* a long note is whole */
    snprintf(name, sizeof name, "%0230d.obj", 7);
    assert_int_equal(rename("fin.obj", name), 0);
    snprintf(line, sizeof line, "surface mesh file=%s", name);
    wr_text_clear(&notes);
    must_run(s, line);
    assert_non_null(strstr(wr_text_get(&notes), "but with exact slopes: 4"));
    assert_int_equal(rename(name, "fin.obj"), 0);
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* The file of a mesh is never the file of an export, by whatever name, from a script of another folder, or of an object
   that is not active. */
static void exports_leave_the_file_alone(void **state)
{
    (void)state;
    static const char *const names[] = { "roof.obj", "./roof.obj", "link.obj" };
    WrText notes = { 0 };
    WrError err = { "" };
    WrSession *s = session_with(&notes);
    write_file("roof.obj", roof);
    must_run(s, "table 37x29");
    assert_int_equal(link("roof.obj", "link.obj"), 0);
    must_run(s, "surface mesh file=roof.obj");
    must_run(s, "object add other");
    must_run(s, "surface torus");
    must_run(s, "save two.exr");
    for (int k = 0; k < 6; k++) {
        WrSession *b = session_with(&notes);
        char line[60];
        if (!wr_session_open(b, "two.exr", &err)) fail_msg("%s", err.text);
        snprintf(line, sizeof line, "export obj %s", names[k / 2]);
        must_fail(k % 2 ? b : s, line, "choose another name");
        wr_session_free(b);
    }
    wr_text_clear(&notes);
    must_run(s, "export obj roof2.obj");
    assert_non_null(strstr(wr_text_get(&notes), "; object 2 of 2, other"));
    wr_text_clear(&notes);
    must_run(s, "object choose \"object 1\"");
    must_run(s, "export obj roof2.obj object=other");
    assert_non_null(strstr(wr_text_get(&notes), "; object 2 of 2, other"));
    must_run(s, "export obj roof2.obj");
    assert_non_null(strstr(wr_text_get(&notes), "; object 1 of 2"));
    assert_int_equal(mkdir("inner", 0700), 0);
    write_file("inner/roof.obj", roof);
    write_file("inner/s.wrinkle", "surface mesh file=roof.obj\n");
    if (!wr_session_open(s, "inner/s.wrinkle", &err)) fail_msg("%s", err.text);
    must_fail(s, "export obj inner/roof.obj", "inner/roof.obj: this file was read as an input");
    char *bytes;
    size_t length;
    if (!wr_file_read("inner/roof.obj", 1 << 20, &bytes, &length, &err)) fail_msg("%s", err.text);
    assert_int_equal(length, sizeof roof - 1);
    assert_memory_equal(bytes, roof, length);
    wr_free(bytes);
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* Maps that lie by (u,v): refused without any, noted where they overlap. Relief below the error is noted with both. */
/* The error that a solid with too many triangles names has fewer, and is not wastefully large. */
static void a_fitting_error_is_named(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    WrError err = { "" };
    write_cube("cube.stl", 30);
    must_run(s, "table 128x128");
    must_run(s, "pattern bricks");
    must_run(s, "bump height=0.1");
    for (int k = 0; k < 3; k += test_amount(1, 2)) {
        /* on the plane the first estimate does not fit */
        static const char *const surfaces[] = {
            "surface mesh file=cube.stl projection=box cell=7mm", "surface torus", "surface plane"
        };
        char line[160];
        double fits = 0;
        const int most = k < 2 ? 3000 : 9000;
        must_run(s, surfaces[k]);
        snprintf(line, sizeof line, "export stl out.stl triangles=%d error=0.0003", most);
        assert_false(wr_session_run(s, line, &err));
        const char *named = strstr(err.text, "triangles: give error=");
        if (!named || sscanf(named, "triangles: give error=%lf", &fits) != 1)
            fail_msg("%s", err.text);
        snprintf(line, sizeof line, "export stl out.stl triangles=%d error=%.6g", most, fits);
        must_run(s, line);
        snprintf(line, sizeof line, "export stl out.stl triangles=%d error=%.6g", most, fits / 6);
        must_fail(s, line, "needs more than");
    }
    wr_session_free(s);
    wr_text_fini(&notes);
    assert_int_equal(unlink("cube.stl"), 0);
    assert_int_equal(unlink("out.stl"), 0);
}

static void maps_and_relief_that_are_lost_are_noted(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("roof.obj", roof);
    write_cube("cube.stl", 10);
    must_run(s, "table 32x32");
    must_run(s, "noise simplex");
    must_run(s, "bump mode=blinn height=0.004");
    must_run(s, "surface mesh file=cube.stl");
    must_fail(s, "export normal-baked n.png", "no texture coordinates for maps: unwrap");
    must_run(s, "surface mesh projection=box");
    wr_text_clear(&notes);
    must_run(s, "export stl out.stl error=0.03");
    assert_non_null(strstr(wr_text_get(&notes),
                           "mm from its lowest to its highest and error=0.03: much of it is lost"));
    wr_text_clear(&notes);
    must_run(s, "export stl out.stl error=0.0009");
    assert_null(strstr(wr_text_get(&notes), "is lost"));
    must_run(s, "surface torus");
    must_run(s, "bump height=0.00004");
    must_run(s, "export stl out.stl");
    assert_non_null(strstr(wr_text_get(&notes), "and error=0.05: much of it is lost"));
    wr_text_clear(&notes);
    must_run(s, "surface mesh file=roof.obj"); /* both sides have the whole table */
    must_run(s, "export normal-baked n.png");
    assert_non_null(strstr(wr_text_get(&notes),
                           "; 100.0% of the texture coordinates are met twice, the first at"));
    assert_non_null(strstr(wr_text_get(&notes), "size=WIDTHxHEIGHT"));
    wr_text_clear(&notes);
    must_run(s, "export normal-baked n.png size=40x30");
    assert_null(strstr(wr_text_get(&notes), "size=WIDTHxHEIGHT"));
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* Copies share the file's mesh in a document, each with its own projection. */
static void objects_have_their_own_projections(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrError err = { "" };
    WrSession *a = session_with(&notes), *b = session_with(&notes);
    write_cube("cube.stl", 30);
    must_run(a, "surface mesh file=cube.stl projection=box");
    must_run(a, "object add second");
    must_run(a, "surface mesh file=cube.stl projection=spherical cell=5mm");
    must_run(a, "object add third");
    must_run(a, "surface mesh file=cube.stl");
    must_run(a, "save all.exr");
    if (!wr_session_open(b, "all.exr", &err)) fail_msg("%s", err.text);
    assert_true(wr_hash_equal(wr_session_hash(a), wr_session_hash(b)));
    for (int i = 0; i < 3; i++)
        assert_true(same_mesh(wr_scene_object(scene_in(a), i)->triangles,
                              wr_scene_object(scene_in(b), i)->triangles));
    assert_false(wr_scene_several_meshes(scene_in(b)));
    wr_session_free(a);
    wr_session_free(b);
    wr_text_fini(&notes);
}

/* Masks and blending are settings of the projection; those without a meaning are dropped. */
static void masks_are_kept(void **state)
{
    (void)state;
    static const char parts[] = "v 0 0 0\nv 1 0 1\nv 1 2 1\nv 0 2 0\nv 2 0 0\nv 2 2 0\n"
                                "usemtl left side\nf 1 2 3 4\nusemtl right\nf 2 5 6 3\n";
    static const struct {
        const char *line, *kept;
    } rows[] = {
        { "projection=box cell=7mm blend=0.37 unit=mm", " cell=7mm blend=0.37 unit=mm\n" },
        { "facing=-y angle=31.7 turn=33.7,-71.3,128.9 at=0.3,12.9,8.77 blend=0.5",
          " turn=33.7,-71.3,128.9 at=0.3,12.9,8.77 facing=-y angle=31.7\n" },
        { "projection=spherical facing=out soft=11.5 materials=\"left side,2\"",
          " facing=out angle=45 soft=11.5 materials=\"left side,2\"\n" },
        { "materials=2 angle=12 soft=3 crease=20", " crease=20 materials=2\n" },
    };
    WrError err = { "" };
    for (int i = 0; i < 8; i++) {
        WrText notes = { 0 }, was = { 0 }, is = { 0 };
        char line[160];
        const char *const name = i % 2 ? "m.ora" : "m.exr";
        WrSession *a = session_with(&notes), *b = session_with(&notes);
        write_file("parts.obj", parts);
        must_run(a, "surface mesh file=parts.obj");
        snprintf(line, sizeof line, "surface mesh %s", rows[i / 2].line);
        must_run(a, line);
        assert_non_null(scene_in(a)->triangles->weights);
        if (!strstr(surface_line(a, &was), rows[i / 2].kept)) fail_msg("%s", wr_text_get(&was));
        snprintf(line, sizeof line, "save %s", name);
        must_run(a, line);
        if (i % 2 == 0) check_version(name, "10");
        if (!wr_session_open(b, name, &err)) fail_msg("%s", err.text);
        assert_string_equal(surface_line(a, &was), surface_line(b, &is));
        assert_true(scene_in(a)->triangles->key == scene_in(b)->triangles->key);
        assert_true(same_mesh(scene_in(a)->triangles, scene_in(b)->triangles));
        assert_non_null(scene_in(b)->triangles->weights);
        must_run(b, "surface mesh projection=uv facing=any materials=\"\" crease=180");
        assert_null(scene_in(b)->triangles->weights);
        assert_null(scene_in(b)->mesh_source);
        wr_session_free(a);
        wr_session_free(b);
        wr_text_fini(&notes);
        wr_text_fini(&was);
        wr_text_fini(&is);
    }
}

/* A note counts the triangles with relief. */
static void masks_are_told_of(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_cube("cube.stl", 30);
    must_run(s, "surface mesh file=cube.stl facing=z");
    assert_non_null(strstr(wr_text_get(&notes), "masks leave relief on 2 of 12 triangles"));
    must_fail(s, "surface mesh materials=lid",
              "materials=lid: the mesh has no such material; it has 1 ");
    must_run(s, "surface mesh projection=box blend=0.2");
    assert_null(strstr(wr_text_get(&notes), "does not run on"));
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* A sheet 4 x 2 of two squares in four triangles, with its own u along x. */
static const char sheet[] = "v 0 0 0\nv 2 0 0\nv 4 0 0\nv 0 2 0\nv 2 2 0\nv 4 2 0\n"
                            "vt 0 0\nvt 0.5 0\nvt 1 0\nvt 0 1\nvt 0.5 1\nvt 1 1\n"
                            "f 1/1 2/2 5/5 4/4\nf 2/2 3/3 6/6 5/5\n";

/* The mask at the centre of a triangle, which is at x. */
static double mask_of(const WrScene *scene, int32_t triangle, double *x)
{
    WrReliefTap taps[WR_RELIEF_TAPS];
    const WrTriangles *t = scene->triangles;
    *x = 0;
    for (int k = 0; k < 3; k++) *x += (double)wr_triangle_corner(t, triangle, k)->p[0] / 3;
    return wr_relief_taps(t, triangle, 1.0 / 3, 1.0 / 3, taps) ? taps[0].weight : 0;
}

static void assert_halves_at(const WrScene *scene, bool right, bool left, int at)
{
    for (int32_t i = 0; i < scene->triangles->triangle_count; i++) {
        double x;
        const double m = mask_of(scene, i, &x);
        if (!(fabs(m - ((x > 2 ? right : left) ? 1 : 0)) < 1e-6))
            fail_msg("line %d: at x = %g the mask is %g", at, x, m);
    }
}
#define assert_halves(scene, right, left) assert_halves_at(scene, right, left, __LINE__)

/* The layer is read as it is painted, in the mesh's own (u,v), and follows edits, undo, other names, documents and its
   own removal. */
static void a_layer_is_a_mask(void **state)
{
    (void)state;
    WrText notes = { 0 }, line = { 0 }, other = { 0 };
    WrError err = { "" };
    WrSession *s = session_with(&notes);
    write_file("sheet.obj", sheet);
    must_run(s, "table 40x24");
    must_run(s, "fill 0.7");
    must_run(s, "layer add where");
    must_run(s, "select rect from=0.5,0 to=1,1");
    must_run(s, "fill 1.3");
    must_run(s, "surface mesh file=sheet.obj mask=2 projection=box cell=3mm turn=0,0,31");
    assert_non_null(strstr(wr_text_get(&notes), "layer 2 was hidden: it is now a mask"));
    assert_non_null(strstr(wr_text_get(&notes), "masks leave relief on 2 of 4 triangles"));
    if (!strstr(surface_line(s, &line), " mask=where\n")) fail_msg("%s", wr_text_get(&line));
    must_run(s, "replicate 3,2");
    assert_halves(scene_in(s), true, false);
    must_run(s, "layer use where"); /* it is painted though it is hidden */
    must_run(s, "select invert");
    must_run(s, "fill 1");
    assert_halves(scene_in(s), true, true);
    must_run(s, "undo");
    assert_halves(scene_in(s), true, false);
    must_run(s, "surface mesh cell=2mm materials=1 projection=planar");
    assert_halves(scene_in(s), true, false);
    must_run(s, "surface mesh projection=uv");
    assert_halves(scene_in(s), true, false);
    must_run(s, "layer rename 2 \"its place\"");
    for (int i = 0; i < 2; i++) {
        const char *const name = i ? "m.ora" : "m.exr";
        WrSession *b = session_with(&notes);
        char save[40];
        snprintf(save, sizeof save, "save %s", name);
        must_run(s, save);
        if (!wr_session_open(b, name, &err)) fail_msg("%s", err.text);
        assert_string_equal(surface_line(s, &line), surface_line(b, &other));
        assert_true(scene_in(s)->triangles->key == scene_in(b)->triangles->key);
        assert_halves(scene_in(b), true, false);
        wr_session_free(b);
    }
    must_run(s, "layer delete 2"); /* nothing limits the relief then */
    assert_halves(scene_in(s), true, true);
    must_run(s, "undo");
    assert_halves(scene_in(s), true, false);
    must_run(s, "object add second"); /* the edited layer may be the mask of another object */
    must_run(s, "surface sphere");
    must_run(s, "fill 2");
    assert_halves(wr_scene_object(scene_in(s), 0), true, true);
    must_run(s, "object choose \"object 1\"");
    must_run(s, "surface mesh mask=\"\" materials=\"\"");
    assert_null(scene_in(s)->triangles->weights);
    assert_null(scene_in(s)->mask_layer);
    wr_session_free(s);
    wr_text_fini(&notes);
    wr_text_fini(&line);
    wr_text_fini(&other);
}

/* A dab on the mesh in the mask layer lies in the mesh's own (u,v), though the mesh shows the table by a projection. */
static void a_mask_is_painted_on_the_mesh(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("sheet.obj", sheet);
    must_run(s, "table 80x40");
    must_run(s, "layer add where");
    must_run(s, "surface mesh file=sheet.obj projection=planar cell=1.7mm at=9,7,0 mask=where");
    must_run(s, "replicate 2,3");
    must_run(s, "sculpt radius=6 strength=1 hardness=0.9 points=3,0.5,0");
    const WrField *where = wr_session_document(s)->layers[1].heights;
    int inside = 0;
    for (int j = 0; j < 40; j++)
        for (int i = 0; i < 80; i++) {
            const double dx = i + 0.5 - 80 * 3 / 4.0, dy = j + 0.5 - 40 * (1 - 0.5 / 2);
            const double away = hypot(dx, dy);
            if (away > 8) assert_near(wr_field_get(where, i, j), 0, 0);
            if (away < 4) assert_true(wr_field_get(where, i, j) > 0.2F);
            inside += away < 4;
        }
    assert_true(inside > 30);
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* The height of the exported body over the sheet. */
static double top_of(WrSession *s, const char *line, const char *path)
{
    WrMesh mesh;
    WrError err = { "" };
    double top = -1;
    must_run(s, line);
    if (!wr_mesh_read_attributes(path, &mesh, &err)) fail_msg("%s", err.text);
    for (int32_t i = 0; i < mesh.point_count; i++) top = fmax(top, (double)mesh.points[i][2]);
    wr_mesh_fini(&mesh);
    return top;
}

/* A solid has the heights of the object's own layer, as its picture; without one, those of all layers. A flat one is
   noted. */
static void solids_have_the_objects_table(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("sheet.obj", sheet);
    must_run(s, "table 9x7");
    must_run(s, "fill 0.3");
    must_run(s, "layer add own");
    must_run(s, "fill 0.4");
    must_run(s, "surface mesh file=sheet.obj");
    must_run(s, "bump height=1");
    assert_near(top_of(s, "export ply all.ply", "all.ply"), 0.7, 1e-6);
    assert_non_null(strstr(wr_text_get(&notes), "no relief: the table is flat"));
    must_run(s, "object set layer=own");
    assert_near(top_of(s, "export ply own.ply", "own.ply"), 0.4, 1e-6);
    must_run(s, "object set name=sheet");
    assert_near(top_of(s, "export ply named.ply object=sheet", "named.ply"), 0.4, 1e-6);
    wr_text_fini(&notes);
    must_run(s, "noise perlin cells=3 amplitude=0.5");
    must_run(s, "export ply rough.ply");
    assert_null(strstr(wr_text_get(&notes), "no relief"));
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* A seam counts where a material with relief has it; at bare faces nothing can break. */
static void seams_without_relief_are_not_counted(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrTextureSeams all, bare, top;
    WrError err = { "" };
    WrSession *s = session_with(&notes);
    write_cube("cube.stl", 30);
    must_run(s, "surface mesh file=cube.stl projection=box cell=7.3mm crease=30 at=1,2,5");
    assert_true(wr_triangles_seams(scene_in(s)->triangles, &all, &err));
    must_run(s, "surface mesh facing=z");
    assert_true(wr_triangles_seams(scene_in(s)->triangles, &top, &err));
    must_run(s, "surface mesh facing=x angle=100"); /* all but -x */
    assert_true(wr_triangles_seams(scene_in(s)->triangles, &bare, &err));
    assert_true(all.edges > 4);
    assert_int_equal(top.edges, 0);
    assert_true(bare.edges > 0 && bare.edges < all.edges);
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* Masks on a file without normals get a note with the remedy, unless crease= is set. */
static void masks_need_normals(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("sheet.obj", sheet);
    must_run(s, "surface mesh file=sheet.obj facing=z crease=20");
    assert_null(strstr(wr_text_get(&notes), "edges look rounded"));
    must_run(s, "surface mesh crease=180");
    assert_non_null(strstr(wr_text_get(&notes), "masks leave relief on 4 of 4 triangles; the file "
                                                "has no normals, so edges look rounded"));
    wr_session_free(s);
    wr_text_fini(&notes);
}

/* Two materials, each on two tiles: a tile halves the parts, and their numbers stay. */
static void tiles_keep_the_numbers_of_materials(void **state)
{
    (void)state;
    static const char tiled[] = "v 0 0 0\nv 2 0 0\nv 4 0 0\nv 0 2 0\nv 2 2 0\nv 4 2 0\n"
                                "vt 0.1 0.1\nvt 0.8 0.1\nvt 0.8 0.8\nvt 0.1 0.8\n"
                                "vt 1.1 0.1\nvt 1.8 0.1\nvt 1.8 0.8\nvt 1.1 0.8\n"
                                "usemtl wood\nf 1/1 2/2 5/3\nf 1/5 5/7 4/8\n"
                                "usemtl iron\nf 2/1 3/2 6/3\nf 2/5 6/7 5/8\n";
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("tiled.obj", tiled);
    must_run(s, "surface mesh file=tiled.obj udim=1002 materials=2");
    const WrTriangles *t = scene_in(s)->triangles;
    assert_int_equal(t->part_count, 4);
    for (int i = 0; i < 4; i++)
        assert_int_equal(wr_relief_covers(t, t->parts[i].first),
                         strcmp(t->parts[i].name, "iron") == 0);
    must_fail(s, "surface mesh materials=3",
              "materials=3: the mesh has no such material; it has 1 wood, 2 iron");
    wr_session_free(s);
    wr_text_fini(&notes);
}

static void masks_of_layers_are_refused(void **state)
{
    (void)state;
    WrText notes = { 0 };
    WrSession *s = session_with(&notes);
    write_file("sheet.obj", sheet);
    write_cube("cube.stl", 30);
    must_run(s, "layer add where");
    must_fail(s, "surface mesh file=cube.stl projection=box mask=where",
              "mask=where: the mesh has no texture coordinates of its own");
    must_run(s, "surface mesh file=sheet.obj");
    must_fail(s, "surface mesh mask=there", "there");
    must_run(s, "object set layer=where");
    must_fail(s, "surface mesh mask=where",
              "that layer is the object's table: choose another layer as its mask");
    assert_true(wr_session_document(s)->layers[1].visible);
    wr_session_free(s);
    wr_text_fini(&notes);
}

static void hostile_projections_are_refused(void **state)
{
    (void)state;
    static const char *const bad[][2] = {
        { "cell=0", "cell=0: must be" },
        { "cell=-1mm", "cell=-1mm: must be" },
        { "cell=nan", "cell=nan: must be" },
        { "cell=1e308in", "cell=1e308in: must be" },
        { "cell=1,2,3", "cell=1,2,3: must be" },
        { "cell=10km", "cell=10km: must be" },
        { "projection=round", "projection=round" },
        { "turn=1,2", "turn=1,2: must be" },
        { "turn=0,0,361", "turn=0,0,361: must be" },
        { "at=0,0,1e10", "at=0,0,1e10: must be" },
        { "unit=mile", "unit=mile" },
        { "crease=-1", "crease=-1: must be" },
        { "crease=180.5", "crease=180.5: must be" },
        { "blend=1.1", "blend=1.1: must be" },
        { "facing=up", "facing=up" },
        { "facing=x angle=181", "angle=181: must be" },
        { "soft=nan", "soft=nan: must be" },
        { "materials=,", "has no such material" },
        { "materials=0", "has no such material" },
        { "projection=box cell=1um unit=m", "extends over more than 65536 cells" },
        { "projection=planar at=1e9,0,0", "extends over more than 65536 cells" },
        { "projection=spherical cell=1e-300", "extends over more than 65536 cells" },
    };
    WrText notes = { 0 };
    char line[160];
    WrSession *s = session_with(&notes);
    write_cube("cube.stl", 30);
    must_run(s, "surface mesh file=cube.stl projection=box");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        for (int with = 0; with < 2; with++) {
            snprintf(line, sizeof line, "surface mesh %s%s", with ? "file=cube.stl " : "",
                     bad[i][0]);
            must_fail(s, line, bad[i][1]);
        }
    must_run(s, "surface mesh projection=spherical cell=1e9 at=1e9,-1e9,1e9 turn=360,-360,1e-300");
    must_run(s, "surface mesh projection=cylindrical cell=2mm,1e9 at=15,15,15 crease=0");
    must_run(s, "surface mesh projection=cylindrical cell=31mm,5mm at=15,15,0");
    assert_null(strstr(wr_text_get(&notes), "leaves a seam"));
    must_run(s, "replicate 0.3,1.5");
    assert_non_null(
        strstr(wr_text_get(&notes), "replicate 0.3,1.5 leaves a seam on the mesh, which has "));
    must_run(s, "surface mesh"); /* the square: nothing is left of the projection */
    must_run(s, "surface mesh file=cube.stl");
    assert_int_equal(scene_in(s)->projection.kind, WR_PROJECTION_UV);
    wr_session_free(s);
    wr_text_fini(&notes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(a_mesh_is_told_of_and_undone, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(documents_carry_it, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(patches_and_terrains_are_kept, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(objects_share_one, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(damaged_meshes_are_refused, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(another_content_is_an_error, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(projections_are_kept, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(a_mesh_is_projected_without_its_file, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(objects_have_their_own_projections, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(masks_are_kept, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(masks_are_told_of, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(a_layer_is_a_mask, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(a_mask_is_painted_on_the_mesh, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(seams_without_relief_are_not_counted, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(masks_need_normals, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(tiles_keep_the_numbers_of_materials, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(solids_have_the_objects_table, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(masks_of_layers_are_refused, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(hostile_projections_are_refused, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_far_mesh_returns_to_its_place, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(faults_are_noted, enter_own_folder, leave_own_folder),
        cmocka_unit_test_setup_teardown(exports_leave_the_file_alone, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(a_fitting_error_is_named, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(maps_and_relief_that_are_lost_are_noted, enter_own_folder,
                                        leave_own_folder),
        cmocka_unit_test_setup_teardown(units_are_the_files, enter_own_folder, leave_own_folder),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
