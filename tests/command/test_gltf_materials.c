/* Materials of glTF files: results of the command gltf compared with the data written here; pictures from a GLB's
   buffer, a data: URI and a separate file; inconsistent files. */
#include "test.h"
#include "test_folder.h"
#include "session_help.h"

#include "base/memory.h"
#include "base/text.h"
#include "image/gltf.h"
#include "image/image.h"
#include "scene/scene.h"
#include "shade/reflection_models.h"

#include <math.h>
#include <stdlib.h>
#include <unistd.h>

enum { W = 7, H = 5 };

/* A picture of three channels; all codes differ, and sRGB conversion changes each. */
static uint8_t code_of(int x, int y, int c, int kind)
{
    return (uint8_t)(20 + (x * 37 + y * 11 + c * 71 + kind * 53) % 211);
}

static char *png_of(int kind, size_t *length)
{
    uint8_t codes[W * H * 3];
    char *bytes, name[16];
    WrError err = { "" };
    snprintf(name, sizeof name, "p%d.png", kind);
    for (int i = 0; i < W * H * 3; i++) codes[i] = code_of(i / 3 % W, i / 3 / W, i % 3, kind);
    if (!wr_image_write_pixels(name, W, H, 3, WR_PIXEL_U8, true, codes, &err))
        fail_msg("%s", err.text);
    FILE *file = fopen(name, "rb");
    assert_non_null(file);
    bytes = test_malloc(65536);
    *length = fread(bytes, 1, 65536, file);
    fclose(file);
    assert_true(*length > 60 && *length < 65536);
    return bytes;
}

static void put_number(FILE *file, size_t x)
{
    for (int k = 0; k < 4; k++) fputc((int)(x >> 8 * k & 0xff), file);
}

/* Write a GLB with a JSON text and a buffer; the header claims `more` bytes beyond the buffer. */
static void put_glb(const char *name, const char *json, const char *bin, size_t length, size_t more)
{
    const size_t text = strlen(json), padded = (text + 3) / 4 * 4;
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    fwrite("glTF", 1, 4, file);
    put_number(file, 2);
    put_number(file, 12 + 8 + padded + (bin ? 8 + length : 0));
    put_number(file, padded);
    fwrite("JSON", 1, 4, file);
    fwrite(json, 1, text, file);
    for (size_t i = text; i < padded; i++) fputc(' ', file);
    if (bin) {
        put_number(file, length + more);
        fwrite("BIN\0", 1, 4, file);
        fwrite(bin, 1, length, file);
    }
    fclose(file);
}

#define ASSET "\"asset\":{\"version\":\"2.0\"},"
#define USED                                                                                       \
    "\"meshes\":[{\"primitives\":[{\"attributes\":{}},{\"attributes\":{},\"material\":1}]}],"
#define TEXTURES "\"textures\":[{\"source\":0},{\"source\":1},{\"source\":2}],"
#define STEEL                                                                                      \
    "\"materials\":[{\"name\":\"Chalk\",\"pbrMetallicRoughness\":{\"metallicFactor\":0}},"         \
    "{\"name\":\"Steel\",\"emissiveFactor\":[0,0.5,0],\"alphaMode\":\"BLEND\","                    \
    "\"extensions\":{\"KHR_materials_sheen\":{}},"                                                 \
    "\"normalTexture\":{\"index\":2,\"scale\":0.625},\"pbrMetallicRoughness\":{"                   \
    "\"baseColorFactor\":[0.3717,0.8123,0.0519,0.7],\"metallicFactor\":0.9371,"                    \
    "\"roughnessFactor\":1,\"baseColorTexture\":{\"index\":0},"                                    \
    "\"metallicRoughnessTexture\":{\"index\":1}}}]"

static const WrScene *scene_of_session(const WrSession *session)
{
    return doc(session)->scene;
}

/* sRGB's curve, IEC 61966-2-1. */
static double linear(int code)
{
    const double x = code / 255.0;
    return x <= 0.04045 ? x / 12.92 : pow((x + 0.055) / 1.055, 2.4);
}

static void expect_steel(const WrSession *session)
{
    const WrScene *scene = scene_of_session(session);
    const WrMaterial *m = &scene->material;
    assert_int_equal(m->model, WR_REFLECT_GGX);
    assert_near(m->colour.x, 0.3717, 1e-15);
    assert_near(m->colour.y, 0.8123, 1e-15);
    assert_near(m->colour.z, 0.0519, 1e-15);
    assert_near(m->metalness, 0.9371, 1e-15);
    assert_near(m->roughness, 1, 1e-15);
    assert_near(m->diffuse, 1, 0);
    assert_near(m->specular, 1, 0);
    assert_non_null(scene->colour);
    assert_non_null(scene->facets[WR_FACET_ROUGHNESS].image);
    assert_non_null(scene->facets[WR_FACET_METALNESS].image);
    assert_non_null(scene->normals.image);
    assert_near(scene->normals.strength, 0.625, 0);
    assert_true(!scene->normals.green_down && !scene->normals.object);
    for (int i = 0; i < W * H; i++) {
        const int x = i % W, y = i / W;
        for (int c = 0; c < 3; c++)
            assert_near((double)scene->colour->data[3 * i + c], linear(code_of(x, y, c, 0)), 1e-6);
        assert_near((double)scene->facets[WR_FACET_ROUGHNESS].image->data[i],
                    code_of(x, y, 1, 1) / 255.0, 1e-6);
        assert_near((double)scene->facets[WR_FACET_METALNESS].image->data[i],
                    code_of(x, y, 2, 1) / 255.0, 1e-6);
        const double nx = code_of(x, y, 0, 2), ny = code_of(x, y, 1, 2), nz = code_of(x, y, 2, 2);
        const float *n = scene->normals.image->data + 3 * i;
        /* the same direction, normalised or not: x z' = z x' */
        const double ax = 2 * nx / 255 - 1, ay = 2 * ny / 255 - 1, az = 2 * nz / 255 - 1;
        if (az > 0.1) {
            assert_near(ax * (double)n[2], az * (double)n[0], 0.02);
            assert_near(ay * (double)n[2], az * (double)n[1], 0.02);
        }
    }
}

static void expect_told(const Said *said, const char *const *words)
{
    for (; *words; words++)
        if (!strstr(said->text, *words)) fail_msg("\"%s\" has not \"%s\"", said->text, *words);
}

static const char *const steel_told[] = { "material 2 of 2 \"Steel\"",
                                          "pictures of colours, roughness, metalness, normals",
                                          "the factor 0.9371 of its picture of metalness",
                                          "emissive light",
                                          "transparency",
                                          "KHR_materials_sheen",
                                          "the opacity",
                                          "other materials",
                                          NULL };

/* From the buffer of a GLB, at unaligned offsets. */
static void a_glb_gives_numbers_and_pictures(void **state)
{
    (void)state;
    char json[4096], *bin = test_malloc(200000);
    size_t at = 5, from[3], length[3];
    for (int k = 0; k < 3; k++) {
        char *png = png_of(k, &length[k]);
        from[k] = at;
        memcpy(bin + at, png, length[k]);
        at += length[k] + 3;
        test_free(png);
    }
    snprintf(json, sizeof json,
             "{" ASSET USED TEXTURES STEEL
             ",\"buffers\":[{\"byteLength\":%zu}],\"images\":[{\"bufferView\":0,\"mimeType\":"
             "\"image/png\"},{\"bufferView\":1},{\"bufferView\":2}],\"bufferViews\":["
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},"
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu},"
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}]}",
             at, from[0], length[0], from[1], length[1], from[2], length[2]);
    put_glb("steel.glb", json, bin, at, 0);
    Said said = { "" };
    WrSession *s = listening(&said);
    must_run(s, "gltf steel.glb");
    expect_steel(s);
    expect_told(&said, steel_told);
    must_run(s, "gltf steel.glb part=Chalk");
    assert_null(scene_of_session(s)->colour);
    assert_null(scene_of_session(s)->facets[WR_FACET_METALNESS].image);
    assert_near(scene_of_session(s)->material.metalness, 0, 0);
    must_run(s, "undo 1");
    expect_steel(s);
    must_run(s, "undo 1");
    assert_int_equal(scene_of_session(s)->material.model, WR_REFLECT_BLINN_PHONG);
    /* by name, as in documents and scripts */
    must_run(s, "gltf steel.glb part=2");
    must_run(s, "colour \"steel.glb#1\" repeat=once");
    assert_near((double)scene_of_session(s)->colour->data[0], linear(code_of(0, 0, 0, 1)), 1e-6);
    must_fail(s, "colour \"steel.glb#3\"", "has no image 3");
    must_fail(s, "gltf steel.glb part=Brass", "no material \"Brass\"");
    put_glb("short.glb", json, bin, at, 9);
    must_fail(s, "gltf short.glb", "longer than the file");
    /* documents contain the pictures themselves */
    WrError err = { "" };
    must_run(s, "gltf steel.glb");
    if (!wr_session_save(s, "kept.exr", &err)) fail_msg("%s", err.text);
    unlink("steel.glb");
    wr_session_free(s);
    s = wr_session_new(NULL);
    must_run(s, "open kept.exr");
    expect_steel(s);
    wr_session_free(s);
    test_free(bin);
}

static void put_text(const char *name, const char *text)
{
    FILE *file = fopen(name, "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    fclose(file);
}

/* RFC 4648, implemented independently. */
static void add_base64(WrText *to, const unsigned char *bytes, size_t length)
{
    static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (size_t bit = 0; bit < 8 * length; bit += 6) {
        unsigned six = 0;
        for (size_t k = bit; k < bit + 6; k++)
            six = six << 1 | (k < 8 * length ? bytes[k / 8] >> (7 - k % 8) & 1U : 0U);
        wr_text_add_n(to, &digits[six], 1);
    }
    while (to->length % 4 != 0) wr_text_add(to, "=");
}

/* One picture as a data: URI, one beside the file, one in a subfolder with an escaped name. */
static void a_gltf_gives_pictures_of_its_own_and_from_beside(void **state)
{
    (void)state;
    size_t length;
    char *png = png_of(0, &length);
    WrText data = { 0 }, json = { 0 };
    add_base64(&data, (const unsigned char *)png, length);
    test_free(png);
    test_free(png_of(1, &length));
    test_free(png_of(2, &length));
    assert_int_equal(rename("p2.png", "nor mal.png"), 0);
    wr_text_addf(&json,
                 "{" ASSET USED TEXTURES STEEL
                 ",\"images\":[{\"uri\":\"data:image/png;base64,%s\"},"
                 "{\"uri\":\"p1.png\"},{\"uri\":\"nor%%20mal.png\"}]}",
                 wr_text_get(&data));
    put_text("steel.gltf", wr_text_get(&json));
    Said said = { "" };
    WrSession *s = listening(&said);
    must_run(s, "gltf steel.gltf");
    expect_steel(s);
    unlink("p1.png");
    said.text[0] = 0;
    must_run(s, "gltf steel.gltf");
    static const char *const told[] = { "the picture of roughness (", "p1.png", NULL };
    expect_told(&said, told);
    assert_null(scene_of_session(s)->facets[WR_FACET_ROUGHNESS].image);
    assert_non_null(scene_of_session(s)->normals.image);
    wr_session_free(s);
    wr_text_fini(&data);
    wr_text_fini(&json);
}

static void lies_are_told(void **state)
{
    static const struct {
        const char *json, *words;
    } lies[] = {
        { "{" ASSET "\"materials\":[]}", "has no materials" },
        { "{" ASSET "\"materials\":[7]}", "material 1 of 1" },
        { "{" ASSET "\"materials\":[{\"pbrMetallicRoughness\":{\"metallicFactor\":7.5}}]}",
          "metallicFactor 7.5: must be a number of 0..1" },
        { "{" ASSET "\"materials\":[{\"pbrMetallicRoughness\":{\"roughnessFactor\":\"x\"}}]}",
          "roughnessFactor" },
        { "{" ASSET "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,1]}}]}",
          "baseColorFactor of 2 numbers: must be 4" },
        { "{" ASSET "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorFactor\":[1,-1,0,1]}}]}",
          "baseColorFactor -1" },
        { "{" ASSET "\"materials\":[{\"normalTexture\":{\"index\":0,\"scale\":1e9}}]}", "scale" },
        { "{" ASSET "\"materials\":[{\"normalTexture\":{\"index\":0,\"scale\":\"2\"}}]}", "scale" },
        { "{" ASSET "\"meshes\":[{\"primitives\":[{\"material\":2147483647}]}],\"materials\":[{}]}",
          "material 2147483648 of 1" },
        { "{" ASSET "\"meshes\":[{\"primitives\":[{\"material\":99}]}],\"materials\":[{}]}",
          "material 100 of 1" },
        { "{" ASSET "\"materials\":[{", "damaged" },
        { "[[[[", "damaged" },
    };
    /* these are loaded, without the picture */
    static const struct {
        const char *image, *words;
    } pictures[] = {
        { "{\"uri\":\"../p0.png\"}", "must be in the file's folder or below" },
        { "{\"uri\":\"/etc/passwd\"}", "must be in the file's folder or below" },
        { "{\"uri\":\"a/%2e%2e/../p0.png\"}", "must be in the file's folder or below" },
        { "{\"uri\":\"file://p0.png\"}", "must be in the file's folder or below" },
        { "{\"uri\":\"data:image/png;base64,!!!!\"}", "not base64" },
        { "{\"uri\":\"data:image/png,abc\"}", "not base64" },
        { "{\"uri\":\"lie.gltf\"}", "neither PNG nor JPEG" },
        { "{\"bufferView\":0}", "bytes 1 to 200000001 of a buffer of 3" },
        { "{\"bufferView\":1}", "has no buffer" },
        { "{\"bufferView\":2}", "has no buffer" },
        { "{\"bufferView\":3}", "must be up to 268435456" },
        { "{\"bufferView\":77}", "is missing" },
        { "{}", "neither uri nor bufferView" },
        { "9", "neither uri nor bufferView" },
    };
    (void)state;
    Said said = { "" };
    WrSession *s = listening(&said);
    for (size_t i = 0; i < sizeof lies / sizeof *lies; i++) {
        put_text("lie.gltf", lies[i].json);
        must_fail(s, "gltf lie.gltf", lies[i].words);
    }
    for (size_t i = 0; i < sizeof pictures / sizeof *pictures; i++) {
        char json[1024];
        snprintf(json, sizeof json,
                 "{" ASSET "\"textures\":[{\"source\":0}],\"images\":[%s],"
                 "\"buffers\":[{\"uri\":\"data:x;base64,AgAA\",\"byteLength\":3}],\"bufferViews\":["
                 "{\"buffer\":0,\"byteOffset\":1,\"byteLength\":200000000},"
                 "{\"buffer\":0,\"byteOffset\":-1,\"byteLength\":2},"
                 "{\"buffer\":4,\"byteLength\":2},{\"buffer\":0,\"byteLength\":2147483647}],"
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0}}}]}",
                 pictures[i].image);
        put_text("lie.gltf", json);
        said.text[0] = 0;
        must_run(s, "gltf lie.gltf");
        const char *const words[] = { pictures[i].words, "the picture of colours", NULL };
        expect_told(&said, words);
        assert_null(scene_of_session(s)->colour);
    }
    put_text("lie.glb", "glTF\1\0\0\0");
    must_fail(s, "gltf lie.glb", "version");
    must_fail(s, "gltf p0.png", "p0.png");
    wr_session_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_glb_gives_numbers_and_pictures),
        cmocka_unit_test(a_gltf_gives_pictures_of_its_own_and_from_beside),
        cmocka_unit_test(lies_are_told),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
