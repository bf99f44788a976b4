/* OBJ files with all features, read without the library and by it. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "image/mesh.h"

/* ---- the whole of a file ---- */

static const char mapped_obj[] = "o left\ng left\nusemtl skin\n"
                                 "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
                                 "vt 0 0\nvt 1 0\nvt 1 0.5\nvt 0 0.5\n"
                                 "vn 0 0 1\nvn 0 1 0\n"
                                 "f 1/1/1 2/2/1 3/3/2 4/4/1\n"
                                 "o right\ng right\nusemtl horn\n"
                                 "v 2 0 0\nf 2 5 3\n";

/* Each corner has the file's normal and (u,v); a part has its name; missing data stays missing. */
static void whole_files(void **state)
{
    (void)state;
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read_whole_bytes("a.obj", mapped_obj, strlen(mapped_obj), &mesh, &err))
        fail_msg("%s", err.text);
    assert_int_equal(mesh.triangle_count, 3);
    assert_int_equal(mesh.part_count, 2);
    assert_int_equal(mesh.parts[1].first, 2);
    assert_int_equal(mesh.parts[0].count, 2);
    assert_string_equal(mesh.parts[0].name, "skin");
    assert_string_equal(mesh.parts[1].name, "horn");
    for (int i = 0; i < 6; i++) {
        const int32_t c = mesh.corners[i / 3][i % 3];
        const float *p = mesh.points[c];
        assert_true(mesh.uv[c][0] == p[0] && mesh.uv[c][1] == p[1] / 2);
        const bool third = p[0] == 1 && p[1] == 1;
        assert_true(mesh.normals[c][1] == (third ? 1 : 0) && mesh.normals[c][2] == (third ? 0 : 1));
    }
    for (int k = 0; k < 3; k++) {
        const int32_t c = mesh.corners[2][k];
        assert_true(isnan(mesh.uv[c][0]));
        assert_true(mesh.normals[c][0] == 0 && mesh.normals[c][2] == 0);
    }
    wr_mesh_fini(&mesh);
    if (!wr_mesh_read_bytes("a.obj", mapped_obj, strlen(mapped_obj), &mesh,
                            &err)) /* not requested */
        fail_msg("%s", err.text);
    assert_null(mesh.uv);
    assert_null(mesh.parts);
    wr_mesh_fini(&mesh);
}

/* ---- OBJ without the library ---- */

#define OBJ_LINES 60

static double any(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (double)(*seed >> 8) / 16777216.0;
}

static int below(uint32_t *seed, int count)
{
    return (int)(any(seed) * count);
}

/* A corner in one of the four forms, counted from the start or from the end. */
static void add_corner(WrText *text, uint32_t *seed, int form, int count)
{
    static const char *const joints[] = { " %d", " %d/%d", " %d//%d", " %d/%d/%d" };
    int k[3];
    for (int i = 0; i < 3; i++) k[i] = below(seed, count) + (below(seed, 3) ? 1 : -count);
    char corner[64];
    if (form == 0) snprintf(corner, sizeof corner, joints[0], k[0]);
    else if (form < 3) snprintf(corner, sizeof corner, joints[form], k[0], k[1]);
    else snprintf(corner, sizeof corner, joints[3], k[0], k[1], k[2]);
    wr_text_add(text, corner);
}

/* A number in one of the forms written by programs, or its shortest. */
static void add_number(WrText *text, uint32_t *seed, bool odd)
{
    static const char *const forms[] = { "%.6f", "%.3f", "%.9g", "%+.5e", "%.17g" };
    wr_text_addf(text, odd ? "\t " : " ");
    wr_text_addf(text, forms[below(seed, 5)], 20 * any(seed) - 10);
}

/* A line end, with other allowed text before it. */
static void add_end(WrText *text, uint32_t *seed, bool odd)
{
    static const char *const ends[] = { "\n", "\r\n", "\n# f 1 2 3\n\n" };
    wr_text_addf(text, odd ? " \t%s  " : "%s", ends[below(seed, 3)]);
}

/* coloured: with three further numbers, as some programs write. */
static void add_place(WrText *text, uint32_t *seed, bool odd, bool coloured)
{
    static const char *const kinds[] = { "v", "vt", "vn" };
    for (int kind = 0; kind < 3; kind++) {
        wr_text_add(text, kinds[kind]);
        for (int k = 0; k < 3 - (kind == 1); k++) add_number(text, seed, odd);
        if (kind == 0 && coloured) wr_text_add(text, " 0.5 1 0");
        add_end(text, seed, odd);
    }
}

/* Each material starts a new part, whose faces have one form. odd: with blanks wherever allowed. */
static void random_obj(WrText *text, uint32_t seed, bool odd)
{
    const bool coloured = seed % 2;
    int form = 3, made = 0;
    wr_text_add(text, "mtllib a.mtl\no thing\nusemtl m0\n");
    for (int i = 0; i < OBJ_LINES; i++) {
        add_place(text, &seed, odd, coloured);
        if (i < 4) continue;
        if (below(&seed, 12) == 0) {
            form = below(&seed, 4);
            wr_text_addf(text, "g part %d\ns off\nusemtl m %d\n", i, ++made);
        }
        wr_text_add(text, "f");
        for (int k = below(&seed, 2); k < 4; k++) add_corner(text, &seed, form, i + 1);
        add_end(text, &seed, odd);
    }
}

static bool alike(float a, float b)
{
    return (isnan(a) && isnan(b)) || fabsf(a - b) <= 2e-6f * fmaxf(1.0f, fabsf(b));
}

static void expect_alike(const WrMesh *a, const WrMesh *b)
{
    assert_int_equal(a->triangle_count, b->triangle_count);
    assert_true(a->point_count <= b->point_count);
    for (int i = 0; i < 3 * a->triangle_count; i++) {
        const int32_t p = a->corners[i / 3][i % 3], q = b->corners[i / 3][i % 3];
        for (int k = 0; k < 3; k++) assert_true(alike(a->points[p][k], b->points[q][k]));
        for (int k = 0; k < 3; k++) assert_true(alike(a->normals[p][k], b->normals[q][k]));
        for (int k = 0; k < 2; k++) assert_true(alike(a->uv[p][k], b->uv[q][k]));
    }
    assert_int_equal(a->part_count, b->part_count);
    for (int i = 0; i < a->part_count; i++) {
        assert_int_equal(a->parts[i].count, b->parts[i].count);
        assert_string_equal(a->parts[i].name, b->parts[i].name);
    }
}

static WrMesh whole_obj(const char *text)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read_whole_bytes("a.obj", text, strlen(text), &mesh, &err))
        fail_msg("%s\n%s", err.text, text);
    return mesh;
}

/* An unknown word leaves the file to the library, which skips the word. */
static void an_obj_file_is_what_the_library_makes_of_it(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 12; seed++) {
        WrText text = { 0 };
        random_obj(&text, seed * 977, false);
        WrMesh own = whole_obj(text.data);
        wr_text_add(&text, "\nbevel off\n");
        WrMesh other = whole_obj(text.data);
        expect_alike(&own, &other);
        assert_true(own.point_count < other.point_count); /* it was read by another path */
        wr_mesh_fini(&own);
        wr_mesh_fini(&other);
        wr_text_fini(&text);
    }
}

/* The same numbers with other blanks are the same mesh, bit for bit. */
static void blanks_do_not_matter(void **state)
{
    (void)state;
    WrText plain = { 0 }, odd = { 0 };
    random_obj(&plain, 4321, false);
    random_obj(&odd, 4321, true);
    WrMesh a = whole_obj(plain.data), b = whole_obj(odd.data);
    assert_int_equal(a.triangle_count, b.triangle_count);
    assert_int_equal(a.point_count, b.point_count);
    assert_memory_equal(a.points, b.points, 12 * (size_t)a.point_count);
    assert_memory_equal(a.uv, b.uv, 8 * (size_t)a.point_count);
    assert_memory_equal(a.corners, b.corners, 12 * (size_t)a.triangle_count);
    wr_mesh_fini(&a);
    wr_mesh_fini(&b);
    wr_text_fini(&plain);
    wr_text_fini(&odd);
}

/* A file left to the library is read, or refused with the library's reason. */
static void what_is_unusual_is_left_to_the_library(void **state)
{
    (void)state;
    static const char five[] = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 1 0.5 0\nv 0 2 0\nf 1 2 3 4 5\n";
    static const char ahead[] = "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n";
    static const char on[] = "v 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nf 1 2 3\n";
    static const char wild[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n";
    WrMesh mesh = whole_obj(five);
    assert_int_equal(mesh.triangle_count, 3); /* a concave pentagon */
    wr_mesh_fini(&mesh);
    mesh = whole_obj(ahead);
    wr_mesh_fini(&mesh);
    mesh = whole_obj(on);
    assert_true(mesh.points[1][0] == 1);
    wr_mesh_fini(&mesh);
    WrError err = { "" };
    assert_false(wr_mesh_read_whole_bytes("a.obj", wild, sizeof wild - 1, &mesh, &err));
    assert_non_null(strstr(err.text, "out of range"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(whole_files),
        cmocka_unit_test(an_obj_file_is_what_the_library_makes_of_it),
        cmocka_unit_test(blanks_do_not_matter),
        cmocka_unit_test(what_is_unusual_is_left_to_the_library),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
