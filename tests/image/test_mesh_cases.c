/* Mesh files in forms that other programs write and readers often misread; correct values by hand. Unless stated
   otherwise, each file of tests/image/cases/mesh is the rectangle of (0,0,0), (2,0,0), (2,1,0), (0,1,0) with u = x / 2, v =
   y. */
#include "test.h"

#include "base/error.h"
#include "base/text.h"
#include "image/mesh.h"

#include <time.h>

static WrMesh read_case(const char *name)
{
    char path[512];
    WrMesh mesh = { 0 };
    WrError err = { "" };
    snprintf(path, sizeof path, WR_SOURCE_DIR "/tests/image/cases/mesh/%s", name);
    if (!wr_mesh_read_attributes(path, &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

static WrMesh read_text(const char *name, const char *text)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (!wr_mesh_read_whole_bytes(name, text, strlen(text), &mesh, &err)) fail_msg("%s", err.text);
    return mesh;
}

static void refuse(const char *name, const char *text, const char *words)
{
    WrMesh mesh = { 0 };
    WrError err = { "" };
    if (wr_mesh_read_bytes(name, text, strlen(text), &mesh, &err)) fail_msg("%s is taken", text);
    if (!strstr(err.text, words)) fail_msg("\"%s\" has not \"%s\"", err.text, words);
}

/* With z = 0 this is also the area of the mesh as seen from above. */
static double area_of(const WrMesh *mesh)
{
    double sum = 0;
    for (int i = 0; i < mesh->triangle_count; i++) {
        const float *p[3];
        for (int k = 0; k < 3; k++) p[k] = mesh->points[mesh->corners[i][k]];
        sum += ((double)p[1][0] - (double)p[0][0]) * ((double)p[2][1] - (double)p[0][1]) -
               ((double)p[2][0] - (double)p[0][0]) * ((double)p[1][1] - (double)p[0][1]);
    }
    return sum / 2;
}

static void expect_rectangle(const char *name, bool mapped)
{
    WrMesh mesh = read_case(name);
    assert_int_equal(mesh.triangle_count, 2);
    assert_near(area_of(&mesh), 2, 1e-6);
    for (int i = 0; i < 6; i++) {
        const int32_t c = mesh.corners[i / 3][i % 3];
        const double x = (double)mesh.points[c][0], y = (double)mesh.points[c][1];
        if (!(fabs(x * (x - 2)) < 1e-6 && fabs(y * (y - 1)) < 1e-6))
            fail_msg("%s: %g,%g", name, x, y);
        if (!mapped) continue;
        if (!(fabs((double)mesh.uv[c][0] - x / 2) < 1e-6 && fabs((double)mesh.uv[c][1] - y) < 1e-6))
            fail_msg("%s: (u,v) %g,%g at %g,%g", name, (double)mesh.uv[c][0], (double)mesh.uv[c][1],
                     x, y);
    }
    for (int k = 0; k < 3; k++) assert_true(mesh.origin[k] >= 0 && mesh.origin[k] <= 0);
    wr_mesh_fini(&mesh);
}

/* m_pose.gltf stores (y, -x, 0) for (x, y, 0). Its joints are at (3, 0, 0) below a node that rotates by a quarter,
   (a, b) to (-b, a), and moves by (5, 0, 0); inverse bind matrices move by (-3, 5, z): (y, 5 - x) is rotated to (x -
   5, y) and moved to (x, y). z is 0 at the left end; at the right one the mean of 2 and -2. The mesh's own node is
   ignored. */
static void files_of_other_programs_are_the_rectangle(void **state)
{
    static const char *const names[] = { "m_uv16.gltf",      "m_quant.gltf",  "m_skin.gltf",
                                         "m_skin2.gltf",     "m_uv2.gltf",    "x_ident.gltf",
                                         "m_pose.gltf",      "p_comment.ply", "o_bom.obj",
                                         "o_comment_end.obj" };
    (void)state;
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) expect_rectangle(names[i], true);
    expect_rectangle("s_upper.stl", false);
}

/* Scale (0.5, 2), a quarter turn, offset (0.25, 0.5), of coordinates with v downwards: u' = 0.25 + 2 v and
   v' = 0.5 - 0.5 u; the file's v is 1 - y, and the mesh's is 1 - v'. */
static void a_texture_transform_moves_coordinates(void **state)
{
    (void)state;
    WrMesh mesh = read_case("m_move.gltf");
    for (int i = 0; i < mesh.point_count; i++) {
        const double u = (double)mesh.points[i][0] / 2, v = 1 - (double)mesh.points[i][1];
        assert_near((double)mesh.uv[i][0], 0.25 + 2 * v, 1e-6);
        assert_near((double)mesh.uv[i][1], 1 - (0.5 - 0.5 * u), 1e-6);
    }
    wr_mesh_fini(&mesh);
}

/* The example of the Khronos specification of KHR_texture_transform: offset (0, 1), a quarter turn, scale 0.5 show
   the lower left quadrant of the picture, rotated clockwise. So the model's top left corner, (0, 0) in glTF, gets the
   quadrant's lower left one, (0, 1); its top right one the quadrant's top left one, (0, 0.5); its lower left one the
   lower right, (0.5, 1). (The GLSL lines of that text rotate in the other direction; its prose, this example and its
   test model are followed.) */
static void a_texture_transform_turns_as_the_specification_shows(void **state)
{
    (void)state;
    WrMesh mesh = read_case("m_quarter.gltf");
    assert_int_equal(mesh.point_count, 4);
    for (int i = 0; i < mesh.point_count; i++) {
        const bool right = mesh.points[i][0] > 1, low = mesh.points[i][1] < 0.5f;
        assert_near((double)mesh.uv[i][0], low ? 0.5 : 0, 1e-6);
        assert_near((double)mesh.uv[i][1], right ? 0.5 : 0, 1e-6); /* upwards */
    }
    wr_mesh_fini(&mesh);
}

static void an_extension_that_is_needed_is_named(void **state)
{
    (void)state;
    char path[512];
    WrMesh mesh = { 0 };
    WrError err = { "" };
    snprintf(path, sizeof path, WR_SOURCE_DIR "/tests/image/cases/mesh/m_instanced.gltf");
    assert_false(wr_mesh_read(path, &mesh, &err));
    assert_non_null(strstr(err.text, "EXT_mesh_gpu_instancing"));
}

/* Two pieces with a gap in u from 0.4 to 0.6 over a seam at x = 1. */
static void faces_have_coordinates_of_their_own(void **state)
{
    (void)state;
    WrMesh mesh = read_case("p_wedge2.ply");
    assert_int_equal(mesh.triangle_count, 4);
    assert_int_equal(mesh.point_count, 8);
    for (int i = 0; i < 12; i++) {
        const int32_t c = mesh.corners[i / 3][i % 3];
        const float x = mesh.points[c][0];
        const float u = i < 6 ? (x > 0.5f ? 0.4f : 0) : (x > 1.5f ? 1 : 0.6f);
        assert_float_equal(mesh.uv[c][0], u, 0);
        assert_float_equal(mesh.uv[c][1], mesh.points[c][1], 0);
    }
    wr_mesh_fini(&mesh);
}

/* 6 and 4 corners make 4 and 2 triangles, which cover 3 unit squares, all with one side up. */
static void strips_are_triangles(void **state)
{
    (void)state;
    WrMesh mesh = read_case("p_strips2.ply");
    assert_int_equal(mesh.triangle_count, 6);
    assert_near(fabs(area_of(&mesh)), 3, 1e-6);
    wr_mesh_fini(&mesh);
}

static void odd_lines_of_obj_files_are_read(void **state)
{
    (void)state;
    WrMesh mesh = read_text("a.obj", "v 0 0 0 1 .5 .5 .5\nv 2 0 0 1 0 0 0\nv 2 1 0 .1 .2 .3 1\n"
                                     "v 0 1 0 1\nvt 0.5\nvt .25 # half\nusemtl a #1\n"
                                     "f 1/1 2/2 3/1 4/ # all\nl 1 2\np 1\n");
    assert_int_equal(mesh.triangle_count, 2);
    assert_near(area_of(&mesh), 2, 0);
    assert_string_equal(mesh.parts[0].name, "a #1");
    assert_float_equal(mesh.uv[1][0], 0.25f, 0);
    assert_float_equal(mesh.uv[1][1], 0, 0);
    wr_mesh_fini(&mesh);
}

/* Read as 0 by the library, which stops at the comma. */
static void decimal_commas_are_refused(void **state)
{
    static const char *const lines[] = { "v 0,5 1 0", "v 0,5 1,25 0,75", "v 1 2 0\nvt 0,5 1" };
    (void)state;
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        char text[96];
        snprintf(text, sizeof text, "v 0 0 0\nv 1 0 0\n%s\nf 1 2 3\n", lines[i]);
        refuse("comma.obj", text, "save it with decimal points");
    }
}

/* An L of six corners, area 3, is not a fan from each of its corners; its dent must not be covered. */
static void dented_polygons_keep_their_area(void **state)
{
    static const int x[6] = { 0, 2, 2, 1, 1, 0 }, y[6] = { 0, 0, 1, 1, 2, 2 };
    (void)state;
    for (int turn = 0; turn < 6; turn++) {
        WrText text = { 0 };
        for (int i = 0; i < 6; i++)
            wr_text_addf(&text, "v %d %d 0\n", x[(i + turn) % 6], y[(i + turn) % 6]);
        wr_text_add(&text, "f 1 2 3 4 5 6\n");
        WrMesh mesh = read_text("l.obj", wr_text_get(&text));
        assert_int_equal(mesh.triangle_count, 4);
        assert_near(area_of(&mesh), 3, 1e-9);
        for (int i = 0; i < 4; i++) { /* none is reversed */
            WrMesh one = mesh;
            one.corners += i, one.triangle_count = 1;
            assert_true(area_of(&one) >= 0);
        }
        wr_mesh_fini(&mesh);
        wr_text_fini(&text);
    }
}

/* ---- far from the origin ---- */

#define FAR_X 432123.25
#define FAR_Y 5678901.5

static void expect_far(WrMesh mesh, double z)
{
    double low = 1e9, high = -1e9;
    assert_near(mesh.origin[0], 432123, 0);
    assert_near(mesh.origin[1], 5678901, 0);
    for (int i = 0; i < mesh.point_count; i++) {
        low = fmin(low, (double)mesh.points[i][0] + mesh.origin[0]);
        high = fmax(high, (double)mesh.points[i][0] + mesh.origin[0]);
    }
    assert_near(low, FAR_X, 1e-7);
    assert_near(high, FAR_X + 2, 1e-7);
    assert_near((double)mesh.points[0][2] + mesh.origin[2], z, 1e-7);
    assert_false(mesh.single);
    wr_mesh_fini(&mesh);
}

/* Floats have steps of 0.03 and of 0.5 there. */
static void far_meshes_keep_their_relief(void **state)
{
    static const double x[4] = { 0, 2, 2, 0 }, y[4] = { 0, 0, 1, 1 };
    WrText obj = { 0 }, ply = { 0 }, stl = { 0 };
    (void)state;
    wr_text_add(&ply, "ply\nformat ascii 1.0\nelement vertex 4\nproperty double x\nproperty double "
                      "y\nproperty double z\nelement face 1\nproperty list uchar int "
                      "vertex_index\nend_header\n");
    for (int i = 0; i < 4; i++) {
        wr_text_addf(&obj, "v %.4f %.4f 250.001\n", FAR_X + x[i], FAR_Y + y[i]);
        wr_text_addf(&ply, "%.4f %.4f 250.001\n", FAR_X + x[i], FAR_Y + y[i]);
    }
    wr_text_add(&obj, "f 1 2 3 4\n");
    wr_text_add(&ply, "4 0 1 2 3\n");
    wr_text_add(&stl, "solid\nfacet normal 0 0 1\nouter loop\n");
    for (int i = 0; i < 3; i++)
        wr_text_addf(&stl, "vertex %.4f %.4f 250.001\n", FAR_X + x[i], FAR_Y + y[i]);
    wr_text_add(&stl, "endloop\nendfacet\nendsolid\n");
    expect_far(read_text("far.obj", wr_text_get(&obj)), 250.001);
    expect_far(read_text("far.ply", wr_text_get(&ply)), 250.001);
    expect_far(read_text("far.stl", wr_text_get(&stl)), 250.001);
    expect_far(read_case("m_far.gltf"), 250);
    wr_text_fini(&obj);
    wr_text_fini(&ply);
    wr_text_fini(&stl);
}

/* ---- damaged files ---- */

static void messages_say_what_is_wrong(void **state)
{
    (void)state;
#define HEAD "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
#define REST "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
    refuse("a.ply", HEAD REST "0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
           "face 1 refers to vertex 3: must be 0..2");
    refuse("a.ply", HEAD REST "0 0 0\n1 0 0\n0 1 0\n3 0 1\n", "it ends in face 1 of 1");
    refuse("a.ply", HEAD REST "0 0 0\n1 0 x7\n0 1 0\n3 0 1 2\n",
           "vertex 2: \"x7\" is not a number");
    refuse("a.ply", HEAD REST "0 0 0\n1 0 0\n0 1 0\n200 0 1 2\n", "a list of 200 numbers");
    refuse("a.ply", HEAD "property folat z\nend_header\n0 0 0 0\n", "type \"folat\"");
    refuse("a.ply", HEAD "end_header\n0 0 0 0\n0 0\n", "no x, y and z");
    refuse("a.ply", HEAD REST, "is damaged: its header has 3 elements");
    refuse("a.ply", HEAD "property float z\n", "no end_header");
    refuse("a.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n",
           "truncated in facet 1");
#undef HEAD
#undef REST
}

static uint32_t any(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

/* A few bytes of each are changed, or it is truncated: each is a mesh or one message, none crashes the reader, and
   all of them together take less time than one of them once did. */
static void no_damaged_ply_file_crashes_the_reader(void **state)
{
    static const char *const names[] = { "p_comment.ply", "p_strips2.ply", "p_wedge2.ply" };
    struct timespec from, to;
    uint32_t seed = 1;
    (void)state;
    clock_gettime(CLOCK_MONOTONIC, &from);
    setenv("WRINKLE_READER", "inside", 1); /* a crash would be this program's */
    for (int i = 0; i < 1200; i++) {
        char path[512], bytes[1024];
        WrMesh mesh = { 0 };
        WrError err = { "" };
        snprintf(path, sizeof path, WR_SOURCE_DIR "/tests/image/cases/mesh/%s", names[i % 3]);
        FILE *file = fopen(path, "rb");
        assert_non_null(file);
        size_t length = fread(bytes, 1, sizeof bytes, file);
        fclose(file);
        for (uint32_t k = any(&seed) % 6; k > 0; k--)
            bytes[any(&seed) % length] =
                (char)(any(&seed) % 3 ? '0' + any(&seed) % 10 : any(&seed));
        if (any(&seed) % 3 == 0) length = 1 + any(&seed) % length;
        if (wr_mesh_read_whole_bytes("cut.ply", bytes, length, &mesh, &err)) wr_mesh_fini(&mesh);
        else assert_non_null(strstr(err.text, "cut.ply: "));
    }
    unsetenv("WRINKLE_READER");
    clock_gettime(CLOCK_MONOTONIC, &to);
    assert_true(to.tv_sec - from.tv_sec < 10);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(files_of_other_programs_are_the_rectangle),
        cmocka_unit_test(a_texture_transform_moves_coordinates),
        cmocka_unit_test(a_texture_transform_turns_as_the_specification_shows),
        cmocka_unit_test(an_extension_that_is_needed_is_named),
        cmocka_unit_test(faces_have_coordinates_of_their_own),
        cmocka_unit_test(strips_are_triangles),
        cmocka_unit_test(odd_lines_of_obj_files_are_read),
        cmocka_unit_test(decimal_commas_are_refused),
        cmocka_unit_test(dented_polygons_keep_their_area),
        cmocka_unit_test(far_meshes_keep_their_relief),
        cmocka_unit_test(messages_say_what_is_wrong),
        cmocka_unit_test(no_damaged_ply_file_crashes_the_reader),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
