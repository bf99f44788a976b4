/* Material files beside a set of maps: their numbers against the maps' texels, their references against the files,
 * names with signs of the formats' own, and what is left out with which reason. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/document.h"
#include "export/map_sets.h"
#include "field/field.h"
#include "image/gltf.h"
#include "image/image.h"
#include "image/mesh.h"
#include "scene/scene.h"
#include "shade/reflection.h"
#include "surface/surface.h"
#include "system/path.h"

#include <expat.h>

#define W 37
#define H 23
#define HEIGHT 1.7 /* millimetres of F = 1 */

/* Any number of -0.5..0.5 for a texel, the same at each run. */
static float noise(int i, int j)
{
    uint32_t x = (uint32_t)(i * 7919 + j * 104729 + 17);
    x = (x ^ x >> 13) * 0x9E3779B1u;
    return (float)(x >> 8) / (1 << 24) - 0.5f;
}

static float height_at(int i, int j)
{
    return 0.2f + noise(i, j) + 0.3f * (float)i / W;
}

/* A cell of 3 x 2 mm, repeated 3 times along u and 5 along v, of a metal. */
static WrDocument *metal_document(void)
{
    WrDocument *document = wr_document_new();
    WrField *field = wr_field_new(W, H, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.0f, NULL);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) wr_field_set(field, i, j, height_at(i, j));
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights = field;
    WrScene *scene = document->scene;
    scene->cell = (WrCellSize){ 3, 2, true, HEIGHT };
    scene->replicate_u = 3, scene->replicate_v = 5;
    scene->shape.kind = WR_SURFACE_plane;
    scene->material.colour = (WrVec3){ 0.25, 0.5, 0.75 };
    for (int i = 0; i < wr_reflect_count; i++)
        if (wr_reflects[i].metalness && wr_reflects[i].roughness) scene->material.model = i;
    scene->material.metalness = 0.625, scene->material.roughness = 0.375;
    return document;
}

typedef struct Written {
    bool good;
    WrText list;
    WrError err;
} Written;

/* Writes a set given as text; the caller frees the list. */
static Written write_text(const WrDocument *document, const char *text, const char *name,
                          const char *word)
{
    Written written = { 0 };
    WrMapSet *set = wr_map_set_parse("test", text, "test", &written.err);
    if (!set) fail_msg("%s", written.err.text);
    const char *const words[] = { word };
    const WrMapSetRequest order = { set, ".", name, words, word != NULL, NULL };
    written.good = wr_export_map_set(&order, document, NULL, &written.list, &written.err);
    wr_map_set_free(set);
    return written;
}

static void must_write(const WrDocument *document, const char *text, const char *name,
                       const char *word, WrText *list)
{
    Written written = write_text(document, text, name, word);
    if (!written.good) fail_msg("%s", written.err.text);
    if (list) *list = written.list;
    else wr_text_fini(&written.list);
}

static char *text_of(const char *path)
{
    char *bytes;
    size_t length;
    WrError err = { "" };
    if (!wr_file_read(path, 1 << 22, &bytes, &length, &err)) fail_msg("%s", err.text);
    return bytes;
}

/* ---- a reader of MaterialX: the value of an input of a node ---- */

typedef struct Search {
    const char *node, *input, *attribute;
    char here[80], found[400];
    int files; /* inputs of type filename whose file exists ... */
    int missing;
} Search;

static const char *attribute(const XML_Char **list, const char *name)
{
    for (; *list; list += 2)
        if (strcmp(list[0], name) == 0) return list[1];
    return "";
}

static void on_start(void *ctx, const XML_Char *element, const XML_Char **list)
{
    Search *search = ctx;
    if (strcmp(element, "input") != 0) {
        snprintf(search->here, sizeof search->here, "%s", attribute(list, "name"));
        return;
    }
    if (strcmp(attribute(list, "type"), "filename") == 0)
        wr_path_is_file(attribute(list, "value")) ? search->files++ : search->missing++;
    if (search->node && strcmp(search->here, search->node) == 0 &&
        strcmp(attribute(list, "name"), search->input) == 0)
        snprintf(search->found, sizeof search->found, "%s", attribute(list, search->attribute));
}

static Search search_mtlx(const char *path, const char *node, const char *input, const char *name)
{
    Search search = { node, input, name, "", "", 0, 0 };
    char *text = text_of(path);
    XML_Parser parser = XML_ParserCreate(NULL);
    XML_SetUserData(parser, &search);
    XML_SetElementHandler(parser, on_start, NULL);
    if (!XML_Parse(parser, text, (int)strlen(text), 1))
        fail_msg("%s: %s", path, XML_ErrorString(XML_GetErrorCode(parser)));
    XML_ParserFree(parser);
    wr_free(text);
    return search;
}

static void mtlx_numbers(const char *path, const char *node, const char *input, double *x,
                         int count)
{
    Search search = search_mtlx(path, node, input, "value");
    const char *at = search.found;
    char *end;
    for (int i = 0; i < count; i++, at = end + (*end == ',')) {
        x[i] = strtod(at, &end);
        if (end == at) fail_msg("%s.%s: '%s'", node, input, search.found);
    }
}

static void assert_mtlx_link(const char *path, const char *node, const char *input,
                             const char *name, const char *is)
{
    assert_string_equal(search_mtlx(path, node, input, name).found, is);
}

/* The numbers after "inputs:NAME = (" in the shader of a USD file. */
static void usd_numbers(const char *text, const char *shader, const char *input, double *x,
                        int count)
{
    char words[80];
    snprintf(words, sizeof words, "def Shader \"%s\"\n", shader);
    const char *at = strstr(text, words);
    if (!at) fail_msg("no shader %s", shader);
    snprintf(words, sizeof words, "inputs:%s = ", input);
    at = strstr(at, words) + strlen(words);
    char *end;
    for (int i = 0; i < count; i++) {
        at += strspn(at, "(, ");
        x[i] = strtod(at, &end);
        assert_true(end > at);
        at = end;
    }
}

/* ---- numbers ---- */

/* Texels of the file, as the two formats turn them to displacements, are the table's heights in millimetres. */
static void assert_heights(const char *file, double tolerance)
{
    WrError err = { "" };
    WrImage *image = wr_image_read(file, &err);
    if (!image) fail_msg("%s", err.text);
    double scale, offset = 0, usd_scale[4], usd_bias[4];
    char *usd = text_of("clay.usda");
    mtlx_numbers("clay.mtlx", "DS_clay", "scale", &scale, 1);
    if (*search_mtlx("clay.mtlx", "height_add", "in2", "value").found)
        mtlx_numbers("clay.mtlx", "height_add", "in2", &offset, 1);
    usd_numbers(usd, "height", "scale", usd_scale, 4);
    usd_numbers(usd, "height", "bias", usd_bias, 4);
    for (int j = 0; j < H; j++)
        for (int i = 0; i < W; i++) {
            const double is = HEIGHT * (double)height_at(i, j), x = (double)image->data[j * W + i];
            assert_near(scale * (x + offset), is, tolerance);
            assert_near(usd_scale[0] * x + usd_bias[0], is, tolerance);
        }
    wr_free(usd);
    wr_image_free(image);
}

static void displacements_are_the_tables_heights(void **state)
{
    (void)state;
    static const struct {
        const char *line, *file;
        double steps; /* of the codes over the range */
    } maps[] = { { "height *_h.png depth=16", "clay_h.png", 65535 },
                 { "height *_h.png depth=8", "clay_h.png", 255 },
                 { "height *_h.png depth=16 range=signed", "clay_h.png", 65534 / 2.0 },
                 { "height *_h.png depth=16 range=-1,2.5", "clay_h.png", 65535 },
                 { "displacement *_h.png depth=16", "clay_h.png", 65535 },
                 { "displacement *_h.png depth=16 range=signed", "clay_h.png", 65534 / 2.0 },
                 { "displacement *_h.exr depth=32", "clay_h.exr", 1e6 },
                 { "height *_h.exr depth=32", "clay_h.exr", 1e6 } };
    WrDocument *document = metal_document();
    for (size_t i = 0; i < sizeof maps / sizeof *maps; i++) {
        must_write(document, maps[i].line, "clay", "material=mtlx,usda", NULL);
        assert_heights(maps[i].file, 0.51 * HEIGHT * 3.5 / maps[i].steps);
    }
    wr_document_free(document);
}

static void the_materials_numbers_and_repeats_are_the_scenes(void **state)
{
    (void)state;
    WrDocument *document = metal_document();
    double x[4];
    must_write(document, "normal+y *_n.png\nmaterial all", "clay", NULL, NULL);
    mtlx_numbers("clay.mtlx", "SR_clay", "base_color", x, 3);
    assert_true(x[0] == 0.25 && x[1] == 0.5 && x[2] == 0.75);
    mtlx_numbers("clay.mtlx", "SR_clay", "specular_roughness", x, 1);
    assert_near(x[0], 0.375, 1e-12);
    mtlx_numbers("clay.mtlx", "SR_clay", "metalness", x, 1);
    assert_near(x[0], 0.625, 0);
    mtlx_numbers("clay.mtlx", "normal_image", "uvtiling", x, 2);
    assert_true(x[0] == 3 && x[1] == 5);
    char *usd = text_of("clay.usda");
    usd_numbers(usd, "surface", "diffuseColor", x, 3);
    assert_true(x[0] == 0.25 && x[1] == 0.5 && x[2] == 0.75);
    usd_numbers(usd, "surface", "roughness", x, 1);
    assert_near(x[0], 0.375, 1e-12);
    usd_numbers(usd, "surface", "metallic", x, 1);
    assert_near(x[0], 0.625, 0);
    usd_numbers(usd, "normal_repeat", "scale", x, 2);
    assert_true(x[0] == 3 && x[1] == 5);
    assert_non_null(strstr(usd, "metersPerUnit = 0.001"));
    assert_non_null(strstr(usd, "extent = [(-4.5, -5, 0), (4.5, 5, 0)]"));
    wr_free(usd);
    WrGltfMaterial material;
    WrError err = { "" };
    if (!wr_gltf_read_material("clay.gltf", NULL, &material, &err)) fail_msg("%s", err.text);
    assert_true(material.colour[0] == 0.25 && material.colour[2] == 0.75);
    assert_near(material.roughness, 0.375, 1e-12);
    assert_near(material.metalness, 0.625, 0);
    assert_string_equal(material.name, "clay");
    wr_document_free(document);
}

/* Both directions of green are the same normals once the formats have read them. */
static void green_down_is_turned_round(void **state)
{
    (void)state;
    WrDocument *document = metal_document();
    WrError err = { "" };
    double scale[2][4], bias[2][4], turn[3], lift[3];
    WrImage *images[2];
    for (int k = 0; k < 2; k++) {
        must_write(document, k ? "normal-y *_d.png depth=16" : "normal+y *_u.png depth=16", "clay",
                   "material=usda,mtlx", NULL);
        char *usd = text_of("clay.usda");
        usd_numbers(usd, "normal", "scale", scale[k], 4);
        usd_numbers(usd, "normal", "bias", bias[k], 4);
        wr_free(usd);
        assert_mtlx_link("clay.mtlx", "normal_map", "in", "nodename",
                         k ? "normal_add" : "normal_image");
        images[k] = wr_image_read(k ? "clay_d.png" : "clay_u.png", &err);
        if (!images[k]) fail_msg("%s", err.text);
    }
    mtlx_numbers("clay.mtlx", "normal_multiply", "in2", turn, 3);
    mtlx_numbers("clay.mtlx", "normal_add", "in2", lift, 3);
    for (int i = 0; i < 3 * W * H; i++) {
        const int c = i % 3;
        const double up = (double)images[0]->data[i], down = (double)images[1]->data[i];
        assert_near(scale[1][c] * down + bias[1][c], 2 * up - 1, 1e-4);
        assert_near(scale[0][c] * up + bias[0][c], 2 * up - 1, 1e-12);
        assert_near(turn[c] * down + lift[c], up, 1e-4);
    }
    for (int k = 0; k < 2; k++) wr_image_free(images[k]);
    wr_document_free(document);
}

/* Smoothness in alpha becomes roughness; occlusion and metalness come from their channels. */
static void packed_channels_are_taken_apart(void **state)
{
    (void)state;
    static const char set[] = "packed *_m.png depth=8 red=metalness green=occlusion blue=1 "
                              "alpha=smoothness base=material\n";
    WrDocument *document = metal_document();
    WrText list;
    double x[4];
    must_write(document, set, "clay", "material=all", &list);
    assert_non_null(strstr(wr_text_get(&list), "glTF needs it in red"));
    assert_non_null(strstr(wr_text_get(&list), "glTF needs it in green"));
    mtlx_numbers("clay.mtlx", "roughness_channel", "index", x, 1);
    assert_near(x[0], 3, 0);
    mtlx_numbers("clay.mtlx", "roughness_multiply", "in2", x, 1);
    assert_near(x[0], -1, 0);
    mtlx_numbers("clay.mtlx", "roughness_add", "in2", x, 1);
    assert_near(x[0], 1, 0);
    assert_mtlx_link("clay.mtlx", "SR_clay", "metalness", "output", "metalness_out");
    char *usd = text_of("clay.usda");
    assert_non_null(strstr(usd, "inputs:roughness.connect = </clay/Material/roughness.outputs:a>"));
    assert_non_null(strstr(usd, "inputs:metallic.connect = </clay/Material/metalness.outputs:r>"));
    assert_non_null(strstr(usd, "inputs:occlusion.connect = </clay/Material/occlusion.outputs:g>"));
    usd_numbers(usd, "roughness", "scale", x, 1);
    assert_near(x[0], -1, 0);
    wr_free(usd);
    wr_text_fini(&list);
    wr_document_free(document);
}

/* ---- references ---- */

/* Image i of the glTF file has the bytes of the file. */
static void assert_picture(const char *gltf, int i, const char *file)
{
    char *bytes, *own;
    size_t length, size;
    WrError err = { "" };
    if (!wr_gltf_picture(gltf, i, &bytes, &length, &err)) fail_msg("%s", err.text);
    if (!wr_file_read(file, 1 << 22, &own, &size, &err)) fail_msg("%s", err.text);
    assert_int_equal(length, size);
    assert_memory_equal(bytes, own, size);
    wr_free(bytes);
    wr_free(own);
}

/* Signs that XML, JSON, URIs and USD's asset paths have meanings for. */
static void any_name_is_referred_to(void **state)
{
    (void)state;
    static const char *const names[] = {
        "clay",       "a b",           "\"q\" & <x> 'y'", "50%25 #1?", "\xc3\xbc\xe6\xbc\x86",
        "at@@@@@ @2", "--> ]]> &amp;", "9.dots.in.it",    "@"
    };
    static const char set[] = "packed *_orm.png depth=8 base=material\nnormal+y *_n.png depth=8\n";
    WrDocument *document = metal_document();
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        char gltf[80], mtlx[80], usda[80], orm[80], normal[80], asset[120];
        WrError err = { "" };
        WrGltfMaterial material;
        snprintf(gltf, sizeof gltf, "%s.gltf", names[k]);
        snprintf(mtlx, sizeof mtlx, "%s.mtlx", names[k]);
        snprintf(usda, sizeof usda, "%s.usda", names[k]);
        snprintf(orm, sizeof orm, "%s_orm.png", names[k]);
        snprintf(normal, sizeof normal, "%s_n.png", names[k]);
        must_write(document, set, names[k], "material=all", NULL);
        Search search = search_mtlx(mtlx, NULL, "", "");
        assert_int_equal(search.missing, 0);
        assert_int_equal(search.files, 3); /* normal, roughness, metalness */
        if (!wr_gltf_read_material(gltf, NULL, &material, &err)) fail_msg("%s", err.text);
        assert_string_equal(material.name, names[k]);
        assert_picture(gltf, material.normal, normal);
        assert_picture(gltf, material.facets, orm);
        char *text = text_of(usda);
        snprintf(asset, sizeof asset, strchr(names[k], '@') ? "= @@@./%s@@@\n" : "= @./%s@\n",
                 strcmp(names[k], "at@@@@@ @2") == 0 ? "at\\@@@@@ @2_n.png" : normal);
        if (!strstr(text, asset)) fail_msg("no %s in %s", asset, text);
        wr_free(text);
    }
    wr_document_free(document);
}

static void a_name_that_is_not_utf8_is_refused(void **state)
{
    (void)state;
    WrDocument *document = metal_document();
    Written written = write_text(document, "normal+y *_n.png", "b\xff", "material=mtlx");
    assert_false(written.good);
    assert_non_null(strstr(written.err.text, "is not UTF-8"));
    assert_false(wr_path_is_there("b\xff_n.png"));
    wr_text_fini(&written.list);
    wr_document_free(document);
}

/* The model of a plane is a rectangle of its cells in metres, 3 x 3 mm by 5 x 2 mm; that of a sphere is the sphere. */
static void a_gltf_file_has_the_model(void **state)
{
    (void)state;
    for (int sphere = 0; sphere < 2; sphere++) {
        WrDocument *document = metal_document();
        WrMesh mesh;
        WrError err = { "" };
        if (sphere) wr_shape_default(WR_SURFACE_sphere, &document->scene->shape);
        must_write(document, "normal+y *_n.png depth=8", "ball", "material=gltf", NULL);
        if (!wr_mesh_read_attributes("ball.gltf", &mesh, &err)) fail_msg("%s", err.text);
        double u = 0, v = 0;
        for (int i = 0; i < mesh.point_count; i++) {
            const float *p = mesh.points[i];
            const double x = (double)p[0], y = (double)p[1], z = (double)p[2];
            u = fmax(u, (double)mesh.uv[i][0]), v = fmax(v, (double)mesh.uv[i][1]);
            if (sphere) assert_near(x * x + y * y + z * z, 1, 1e-6);
            else assert_true(fabs(fabs(x) - 0.0045) < 1e-8 && fabs(fabs(y) - 0.005) < 1e-8);
        }
        if (!sphere) assert_int_equal(mesh.triangle_count, 2);
        else assert_true(mesh.triangle_count > 1000);
        assert_near(u, 3, 1e-6);
        assert_near(v, 5, 1e-6);
        wr_mesh_fini(&mesh);
        wr_document_free(document);
    }
}

/* ---- which files ---- */

static void what_a_format_cannot_use_is_told(void **state)
{
    (void)state;
    static const char set[] = "normal-y *_n.png depth=8\nheight *_h.png\ncurvature *_c.png\n"
                              "occlusion *_o.exr\nroughness *_r.png depth=8\n"
                              "normal+y *_s.png axes=+x+z+y\n";
    static const char *const told[] = {
        "clay.mtlx: MaterialX with normal, height (",
        "clay_c.png: no input for it",
        "occlusion of clay_o.exr: the standard surface has no input for it",
        "clay_s.png: its axes are not those of a tangent space",
        "normal of clay_n.png: glTF needs +Y normals",
        "height of clay_h.png: glTF has no displacement",
        "occlusion of clay_o.exr: glTF reads PNG and JPEG only",
        "roughness of clay_r.png: glTF needs it in green, with metalness in blue",
        "clay.usda: USD preview surface with normal, height ("
    };
    WrDocument *document = metal_document();
    WrText list;
    must_write(document, set, "clay", "material=all", &list);
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        if (!strstr(wr_text_get(&list), told[i]))
            fail_msg("%s is not in %s", told[i], wr_text_get(&list));
    wr_text_fini(&list);
    wr_document_free(document);
}

static void forget(void)
{
    static const char *const files[] = { "clay.mtlx", "clay.usda", "clay.gltf", "clay.bin",
                                         "clay_n.png" };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) wr_path_remove(files[i]);
}

static void a_set_and_the_word_say_which_formats(void **state)
{
    (void)state;
    static const struct {
        const char *set, *word;
        bool mtlx, usda, gltf;
    } rows[] = { { "normal+y *_n.png", NULL, false, false, false },
                 { "normal+y *_n.png", "material=all", true, true, true },
                 { "normal+y *_n.png", "material=gltf,mtlx", true, false, true },
                 { "material mtlx,usda\nnormal+y *_n.png", NULL, true, true, false },
                 { "material mtlx,usda\nnormal+y *_n.png", "material=none", false, false, false },
                 { "material mtlx,usda\nnormal+y *_n.png", "material=gltf", false, false, true } };
    WrDocument *document = metal_document();
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        forget();
        must_write(document, rows[i].set, "clay", rows[i].word, NULL);
        assert_int_equal(wr_path_is_file("clay.mtlx"), rows[i].mtlx);
        assert_int_equal(wr_path_is_file("clay.usda"), rows[i].usda);
        assert_int_equal(wr_path_is_file("clay.gltf"), rows[i].gltf);
        assert_int_equal(wr_path_is_file("clay.bin"), rows[i].gltf);
    }
    Written wrong = write_text(document, "normal+y *_n.png", "clay", "material=mtlz");
    assert_false(wrong.good);
    assert_non_null(strstr(wrong.err.text, "material 'mtlz': did you mean mtlx?"));
    wr_text_fini(&wrong.list);
    wr_document_free(document);
}

/* The place of the last file is taken by a folder: no map is replaced. */
static void material_files_belong_to_the_group(void **state)
{
    (void)state;
    WrDocument *document = metal_document();
    WrError err = { "" };
    forget();
    assert_true(wr_file_write("clay_n.png", "old", 3, &err));
    assert_true(wr_folder_make("clay.gltf", WR_FOLDER_FOR_ALL));
    Written written = write_text(document, "normal+y *_n.png", "clay", "material=all");
    assert_false(written.good);
    assert_int_equal(written.list.length, 0);
    wr_text_fini(&written.list);
    char *old = text_of("clay_n.png");
    assert_string_equal(old, "old");
    wr_free(old);
    assert_false(wr_path_is_there("clay.mtlx"));
    assert_false(wr_path_is_there("clay.bin"));
    assert_true(wr_folder_remove("clay.gltf"));
    wr_document_free(document);
}

/* Colours of a picture: a file of the group with their sRGB codes, multiplied by the material's. */
static void a_picture_of_colours_is_written(void **state)
{
    (void)state;
    WrDocument *document = metal_document();
    WrError err = { "" };
    float rgb[5 * 3 * 3];
    for (int i = 0; i < 45; i++) rgb[i] = 0.5f + noise(i, 3);
    if (!wr_image_write_pixels("from.exr", 5, 3, 3, WR_PIXEL_F32, false, rgb, &err))
        fail_msg("%s", err.text);
    document->scene->colour = wr_image_read("from.exr", &err);
    assert_non_null(document->scene->colour);
    must_write(document, "normal+y *_n.png depth=8", "clay", "material=all", NULL);
    WrImage *image = wr_image_read("clay_colour.png", &err);
    if (!image) fail_msg("%s", err.text);
    assert_true(image->width == 5 && image->height == 3);
    for (int i = 0; i < 45; i++) {
        const double x = (double)rgb[i];
        const double code = x <= 0.0031308 ? 12.92 * x : 1.055 * pow(x, 1 / 2.4) - 0.055;
        const double is = (double)image->data[i];
        const double read = is <= 0.0031308 ? 12.92 * is : 1.055 * pow(is, 1 / 2.4) - 0.055;
        if (fabs(is - code) > 0.503 / 255) assert_near(read, code, 0.503 / 255);
    }
    wr_image_free(image);
    assert_mtlx_link("clay.mtlx", "colour_image", "file", "colorspace", "srgb_texture");
    assert_mtlx_link("clay.mtlx", "normal_image", "file", "colorspace", "none");
    assert_mtlx_link("clay.mtlx", "SR_clay", "base_color", "output", "colour_out");
    WrGltfMaterial material;
    if (!wr_gltf_read_material("clay.gltf", NULL, &material, &err)) fail_msg("%s", err.text);
    assert_picture("clay.gltf", material.base, "clay_colour.png");
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(displacements_are_the_tables_heights),
        cmocka_unit_test(the_materials_numbers_and_repeats_are_the_scenes),
        cmocka_unit_test(green_down_is_turned_round),
        cmocka_unit_test(packed_channels_are_taken_apart),
        cmocka_unit_test(any_name_is_referred_to),
        cmocka_unit_test(a_name_that_is_not_utf8_is_refused),
        cmocka_unit_test(a_gltf_file_has_the_model),
        cmocka_unit_test(what_a_format_cannot_use_is_told),
        cmocka_unit_test(a_set_and_the_word_say_which_formats),
        cmocka_unit_test(material_files_belong_to_the_group),
        cmocka_unit_test(a_picture_of_colours_is_written),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
