/* OpenRaster files: the program's own are restored bit for bit and valid for others; files of other programs become
   layers; hostile ones give one clear message. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/text.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/ora.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <sys/stat.h>
#include <unistd.h>
#include <zip.h>

/* ---- documents ---- */

static WrField *random_field(int width, int height, WrWrap u, WrWrap v, double low, double high,
                             uint64_t seed)
{
    TestRandom random = { seed };
    WrField *field = wr_field_new(width, height, u, v, 0.0f, NULL);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(low + (high - low) * test_random(&random)));
    return field;
}

static const char *const names[] = { "base", "a <b> & \"c\"\n\td\xc3\xa9", "bad \x01\xff name",
                                     "" };

/* Four layers that together use every feature of a layer. */
static WrDocument *make_document(int width, int height)
{
    const WrWrap u = WR_WRAP_CLAMP, v = WR_WRAP_PERIODIC;
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, random_field(width, height, u, v, -3.0, 5.0, 1));
    for (int i = 1; i < 4; i++) {
        WrLayer layer = wr_layer_make(names[i], document->layers[0].heights);
        wr_field_free(layer.heights);
        layer.heights = random_field(width, height, u, v, -1.0, 1.0, (uint64_t)i + 10);
        wr_field_set(layer.cover, i, 0, 0.3f);
        if (i == 2) layer.mask = random_field(width, height, u, v, 0.0, 1.0, 77);
        layer.blend = (WrBlend)(3 * i - 1);
        layer.opacity = 1.0f / (float)(i + 2);
        layer.radius = 0.1f * (float)i;
        layer.visible = i != 3;
        layer.locked = i == 1;
        wr_document_insert(document, i, layer);
    }
    wr_field_set(document->layers[1].heights, 0, 0, -0.0f);
    wr_field_set(document->layers[1].heights, 1, 0, 1e-45f);
    wr_field_set(document->layers[1].heights, 2, 0, 3e38f);
    document->selection = random_field(width, height, u, v, 0.0, 1.0, 5);
    document->active = 2;
    document->solo = 1;
    return document;
}

static void save(const WrDocument *document, const char *scene, const char *path)
{
    WrError err = { "" };
    if (!wr_ora_save(document, scene, path, NULL, &err)) fail_msg("%s", err.text);
}

static WrLoaded load(const char *path, WrText *notes)
{
    WrError err = { "" };
    WrLoaded loaded = { 0 };
    int64_t replaced = -1;
    if (!wr_ora_load(path, &loaded, &replaced, notes, &err)) fail_msg("%s", err.text);
    assert_int_equal(replaced, 0);
    return loaded;
}

static void drop(WrLoaded *loaded)
{
    wr_document_free(loaded->document);
    wr_image_free(loaded->pictures[0][WR_OBJECT_COLOUR]);
    wr_free(loaded->scene_text);
}

static void what_was_saved_comes_back_bit_for_bit(void **state)
{
    (void)state;
    static const char scene[] = "surface torus R=1 r=0.35\nbump height=0.1\n# <&>\xc3\xa9\n";
    const int sizes[][2] = { { 150, 70 }, { 64, 64 }, { 5, 3 }, { 4, 300 } };
    for (int k = 0; k < 4; k++) {
        WrDocument *document = make_document(sizes[k][0], sizes[k][1]);
        WrHash before = wr_document_hash(document, scene);
        save(document, scene, "a.ora");
        assert_true(wr_ora_recognise("a.ora"));
        WrText notes = { 0 };
        WrLoaded loaded = load("a.ora", &notes);
        assert_string_equal(wr_text_get(&notes), "");
        assert_string_equal(loaded.scene_text, scene);
        assert_true(loaded.newer_version == 0.0);
        for (int i = 0; i < 4; i++) /* without a name */
            assert_string_equal(loaded.document->layers[i].name, i == 3 ? "layer 4" : names[i]);
        wr_free(loaded.document->layers[3].name);
        loaded.document->layers[3].name = wr_strdup("");
        assert_true(wr_hash_equal(wr_document_hash(loaded.document, loaded.scene_text), before));
        wr_text_fini(&notes);
        drop(&loaded);
        wr_document_free(document);
    }
}

static void an_empty_document_stays_as_small_as_it_is(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    save(document, "", "a.ora");
    WrLoaded loaded = load("a.ora", NULL);
    assert_true(
        wr_hash_equal(wr_document_hash(loaded.document, ""), wr_document_hash(document, "")));
    assert_int_equal(wr_field_bytes(loaded.document->layers[0].heights),
                     wr_field_bytes(document->layers[0].heights));
    drop(&loaded);
    wr_document_free(document);
}

static void the_colour_picture_travels_along(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    WrScene *scene = wr_scene_clone(document->scene);
    scene->colour = wr_image_new(7, 5, 3, NULL);
    TestRandom random = { 3 };
    for (int i = 0; i < 105; i++) scene->colour->data[i] = (float)test_random(&random);
    wr_scene_free(document->scene);
    document->scene = scene;
    save(document, "", "a.ora");
    WrLoaded loaded = load("a.ora", NULL);
    assert_non_null(loaded.pictures[0][WR_OBJECT_COLOUR]);
    assert_int_equal(loaded.pictures[0][WR_OBJECT_COLOUR]->width * 10 +
                         loaded.pictures[0][WR_OBJECT_COLOUR]->height,
                     75);
    assert_memory_equal(loaded.pictures[0][WR_OBJECT_COLOUR]->data, scene->colour->data,
                        105 * sizeof(float));
    drop(&loaded);
    wr_document_free(document);
}

static void the_same_document_gives_the_same_bytes_a_while_later(void **state)
{
    (void)state;
    WrDocument *document = make_document(90, 40);
    char *a, *b;
    size_t length_a, length_b;
    WrError err;
    save(document, "x", "a.ora");
    assert_true(wr_file_read("a.ora", 1 << 24, &a, &length_a, &err));
    usleep(2100000); /* archives store even seconds */
    WrLoaded loaded = load("a.ora", NULL);
    wr_free(loaded.document->layers[3].name);
    loaded.document->layers[3].name = wr_strdup("");
    save(loaded.document, loaded.scene_text, "b.ora");
    assert_true(wr_file_read("b.ora", 1 << 24, &b, &length_b, &err));
    assert_int_equal(length_a, length_b);
    assert_memory_equal(a, b, length_a);
    wr_free(a);
    wr_free(b);
    drop(&loaded);
    wr_document_free(document);
}

/* ---- other programs ---- */

static WrImage *picture_in(zip_t *archive, const char *name)
{
    zip_stat_t is;
    assert_int_equal(zip_stat(archive, name, 0, &is), 0);
    char *bytes = malloc(is.size);
    zip_file_t *file = zip_fopen(archive, name, 0);
    assert_int_equal(zip_fread(file, bytes, is.size), is.size);
    zip_fclose(file);
    WrError err = { "" };
    WrImage *image = wr_image_read_bytes(name, bytes, is.size, &err);
    if (!image) fail_msg("%s", err.text);
    free(bytes);
    return image;
}

static void the_archive_is_laid_out_as_the_format_wants(void **state)
{
    (void)state;
    WrDocument *document = make_document(600, 90);
    save(document, "", "a.ora");
    char *bytes;
    size_t length;
    WrError err;
    assert_true(wr_file_read("a.ora", 1 << 26, &bytes, &length, &err));
    /* The first local header: PK 3 4, method 0 at 8, name of 8 bytes, no extra field, then the content. */
    static const unsigned char sizes[12] = { 16, 0, 0, 0, 16, 0, 0, 0, 8, 0, 0, 0 };
    assert_memory_equal(bytes, "PK\3\4", 4);
    assert_int_equal(bytes[8], 0);
    assert_memory_equal(bytes + 18, sizes, sizeof sizes);
    assert_memory_equal(bytes + 30, "mimetypeimage/openrasterPK", 26);
    wr_free(bytes);
    zip_t *archive = zip_open("a.ora", ZIP_RDONLY | ZIP_CHECKCONS, NULL);
    assert_non_null(archive);
    assert_string_equal(zip_get_name(archive, 0, 0), "mimetype");
    for (zip_uint64_t i = 0; i < (zip_uint64_t)zip_get_num_entries(archive, 0); i++) {
        zip_stat_t is;
        assert_int_equal(zip_stat_index(archive, i, 0, &is), 0);
        assert_true(is.comp_method == ZIP_CM_STORE || is.comp_method == ZIP_CM_DEFLATE);
    }
    assert_true(zip_name_locate(archive, "stack.xml", 0) > 0);
    WrImage *thumbnail = picture_in(archive, "Thumbnails/thumbnail.png");
    assert_int_equal(thumbnail->type, WR_PIXEL_U8);
    assert_int_equal(thumbnail->width, 256);
    assert_int_equal(thumbnail->height, 90 * 256 / 600);
    wr_image_free(thumbnail);
    zip_discard(archive);
    wr_document_free(document);
}

/* Transparent in programs without filters. */
static void a_filters_preview_is_transparent(void **state)
{
    (void)state;
    WrDocument *document = make_document(33, 21);
    WrFilter filter = wr_filter_of(wr_op_find("blur"));
    document->solo = -1;
    document->active = 0;
    wr_document_add_filter(document, "soft", &filter);
    save(document, "", "a.ora");
    zip_t *archive = zip_open("a.ora", ZIP_RDONLY, NULL);
    WrImage *image = picture_in(archive, "data/layer2.png");
    for (int k = 0; k < 33 * 21; k++) assert_near(image->data[4 * k + 3], 0, 0);
    wr_image_free(image);
    zip_discard(archive);
    wr_document_free(document);
}

static void previews_show_heights_over_the_stated_range(void **state)
{
    (void)state;
    WrDocument *document = make_document(80, 70);
    wr_field_set(document->layers[1].heights, 2, 0, 0.0f); /* not 3e38 */
    document->solo = -1;
    save(document, "", "a.ora");
    float low = 0.0f, high = 1.0f, a, b; /* of the composite and of all layers, at least 0..1 */
    for (int i = -1; i < 4; i++) {
        wr_field_range(i < 0 ? wr_document_field(document) : document->layers[i].heights, &a, &b);
        low = a < low ? a : low;
        high = b > high ? b : high;
    }
    zip_t *archive = zip_open("a.ora", ZIP_RDONLY, NULL);
    for (int i = -1; i < 4; i++) {
        char name[32] = "mergedimage.png";
        if (i >= 0) snprintf(name, sizeof name, "data/layer%d.png", i + 1);
        WrImage *image = picture_in(archive, name);
        assert_int_equal(image->type, WR_PIXEL_U16);
        assert_int_equal(image->channels, 4);
        const WrField *heights = i < 0 ? wr_document_field(document) : document->layers[i].heights;
        for (int k = 0; k < 80 * 70; k++) {
            int x = k % 80, y = k / 80;
            double height = wr_field_get(heights, x, y);
            double want = (height - low) / ((double)high - low);
            if (i >= 0 && document->layers[i].blend == WR_BLEND_MULTIPLY)
                /* the factor used by other programs */
                want = height > 0 ? height < 1 ? height : 1 : 0;
            double alpha = 1.0;
            if (i >= 0 && document->layers[i].cover)
                alpha *= wr_field_get(document->layers[i].cover, x, y);
            if (i >= 0 && document->layers[i].mask)
                alpha *= wr_field_get(document->layers[i].mask, x, y);
            for (int c = 0; c < 3; c++) assert_near(image->data[4 * k + c], want, 0.51 / 65535);
            assert_near(image->data[4 * k + 3], alpha, 0.51 / 65535);
        }
        wr_image_free(image);
    }
    zip_discard(archive);
    wr_document_free(document);
}

/* ---- files of other programs ---- */

typedef struct Part {
    const char *name, *bytes;
    size_t length; /* 0: a text */
    int method;
} Part;

static void write_archive(const char *path, const Part *parts, int count)
{
    unlink(path);
    zip_t *archive = zip_open(path, ZIP_CREATE | ZIP_EXCL, NULL);
    assert_non_null(archive);
    for (int i = 0; i < count; i++) {
        size_t length = parts[i].length ? parts[i].length : strlen(parts[i].bytes);
        zip_source_t *source = zip_source_buffer(archive, parts[i].bytes, length, 0);
        zip_int64_t index = zip_file_add(archive, parts[i].name, source, 0);
        assert_true(index >= 0);
        zip_set_file_compression(archive, (zip_uint64_t)index, parts[i].method, 0);
    }
    assert_int_equal(zip_close(archive), 0);
}

/* A PNG in memory; codes [height][width][channels]. */
static Part png(const char *name, int width, int height, int channels, const uint8_t *codes)
{
    WrError err = { "" };
    char *bytes = NULL;
    size_t length = 0;
    if (!wr_image_write_pixels("part.png", width, height, channels, WR_PIXEL_U8, false, codes,
                               &err) ||
        !wr_file_read("part.png", 1 << 24, &bytes, &length, &err))
        fail_msg("%s", err.text);
    return (Part){ name, bytes, length, ZIP_CM_STORE };
}

#define TYPE                                                                                       \
    {                                                                                              \
        "mimetype", "image/openraster", 0, ZIP_CM_STORE                                            \
    }

static void a_strangers_layers_become_heights_and_coverage(void **state)
{
    (void)state;
    static const char xml[] =
        "<?xml version='1.0' encoding='UTF-8'?>\n"
        "<image version='0.0.3' w='6' h='4' xres='300' yres='300'><stack>\n"
        " <layer name='top &lt;1&gt;' src='data/rgba.png' x='4' y='-1' opacity='0.25'"
        " composite-op='svg:plus'/>\n"
        " <stack name='group' opacity='0.5' visibility='hidden' x='1' y='1'>\n"
        "  <layer name='in' src='data/grey.png' x='-2' y='0' opacity='0.5'"
        "   composite-op='svg:color-burn'/>\n"
        " </stack>\n"
        " <filter type='x'><layer src='data/none.png'/></filter>\n"
        " <layer src='data/full.png' selected='true' edit-locked='true'/>\n"
        "</stack></image>\n";
    /* row 0 is at the top */
    static const uint8_t rgba[2 * 2 * 4] = { 255, 0,   0, 255, 9,  9,  9,  9,
                                             0,   255, 0, 128, 70, 70, 70, 0 };
    static const uint8_t grey[2] = { 51, 102 };
    uint8_t full[6 * 4 * 3];
    for (int i = 0; i < 72; i++) full[i] = (uint8_t)(i / 3 * 10);
    Part parts[] = { TYPE,
                     { "stack.xml", xml, 0, ZIP_CM_DEFLATE },
                     png("data/rgba.png", 2, 2, 4, rgba),
                     png("data/grey.png", 2, 1, 1, grey),
                     png("data/full.png", 6, 4, 3, full) };
    write_archive("foreign.ora", parts, 5);
    for (int i = 2; i < 5; i++) wr_free((char *)parts[i].bytes);
    WrText notes = { 0 };
    WrLoaded loaded = load("foreign.ora", &notes);
    const WrDocument *document = loaded.document;
    assert_int_equal(document->layer_count, 4);
    assert_string_equal(loaded.scene_text, "");
    assert_int_equal(document->active, 0);
    const WrLayer *bottom = &document->layers[0], *in = &document->layers[1],
                  *group = &document->layers[2], *top = &document->layers[3];
    assert_true(group->is_group && group->depth == 0 && in->depth == 1 && !in->is_group);
    assert_string_equal(group->name, "group");
    assert_true(!group->visible && group->opacity == 0.5f && group->blend == WR_BLEND_REPLACE);
    assert_int_equal(wr_field_width(bottom->heights), 6);
    assert_int_equal(wr_field_height(bottom->heights), 4);
    assert_null(bottom->cover); /* opaque and as large as the canvas */
    assert_true(bottom->locked && bottom->opacity == 1.0f && bottom->blend == WR_BLEND_REPLACE);
    assert_string_equal(bottom->name, "layer 1");
    for (int i = 0; i < 24; i++)
        assert_near(wr_field_get(bottom->heights, i % 6, i / 6), i * 10 / 255.0, 1e-6);
    /* x = -2 + 1: the first of two pixels is cut off; y = 0 + 1. */
    assert_true(in->visible && in->opacity == 0.5f && in->blend == WR_BLEND_REPLACE);
    assert_non_null(in->cover);
    for (int i = 0; i < 24; i++) {
        bool there = i == 6;
        assert_true(wr_field_get(in->cover, i % 6, i / 6) == (there ? 1.0f : 0.0f));
        assert_near(wr_field_get(in->heights, i % 6, i / 6), there ? 102 / 255.0 : 0.0, 1e-6);
    }
    /* y = -1: its second row is on the first one. Green's share of luma; nothing where alpha is 0. */
    assert_string_equal(top->name, "top <1>");
    assert_true(top->visible && top->opacity == 0.25f && top->blend == WR_BLEND_ADD);
    for (int i = 0; i < 24; i++) {
        assert_near(wr_field_get(top->cover, i % 6, i / 6), i == 4 ? 128 / 255.0 : 0.0, 1e-6);
        assert_near(wr_field_get(top->heights, i % 6, i / 6), i == 4 ? 0.7152 : 0.0, 1e-6);
    }
    assert_non_null(strstr(wr_text_get(&notes), "layer 'in': its blend mode is not known"));
    assert_non_null(strstr(wr_text_get(&notes), "the layers of 1 groups blend with those below"));
    assert_non_null(strstr(wr_text_get(&notes), "1 elements that are no layers were passed over"));
    wr_text_fini(&notes);
    drop(&loaded);
}

static void a_file_of_ours_from_another_program_keeps_its_pictures(void **state)
{
    (void)state;
    /* As written by a program that ignores our attributes: the PNGs alone. */
    static const char xml[] = "<image w='3' h='1'><stack><layer name='a' src='data/layer1.png'/>"
                              "</stack></image>";
    static const uint8_t codes[3] = { 0, 128, 255 };
    Part parts[] = { TYPE,
                     { "stack.xml", xml, 0, ZIP_CM_DEFLATE },
                     png("data/layer1.png", 3, 1, 1, codes) };
    write_archive("back.ora", parts, 3);
    wr_free((char *)parts[2].bytes);
    WrLoaded loaded = load("back.ora", NULL);
    assert_true(wr_field_get(loaded.document->layers[0].heights, 2, 0) == 1.0f);
    assert_true(wr_field_wrap_u(loaded.document->layers[0].heights) == WR_WRAP_PERIODIC);
    drop(&loaded);
}

/* Subtract is saved as difference, the nearest available mode, and restored if our attributes are missing. */
static void difference_comes_back_as_subtract(void **state)
{
    (void)state;
    static const char xml[] = "<image w='3' h='1'><stack>"
                              "<layer name='a' composite-op='svg:difference' src='data/a.png'/>"
                              "<layer name='b' src='data/a.png'/></stack></image>";
    static const uint8_t codes[3] = { 0, 51, 255 };
    Part parts[] = { TYPE,
                     { "stack.xml", xml, 0, ZIP_CM_DEFLATE },
                     png("data/a.png", 3, 1, 1, codes) };
    write_archive("difference.ora", parts, 3);
    wr_free((char *)parts[2].bytes);
    WrText notes = { 0 };
    WrLoaded loaded = load("difference.ora", &notes);
    const WrLayer *top = &loaded.document->layers[1];
    assert_int_equal(top->blend, WR_BLEND_SUBTRACT);
    assert_near(wr_field_get(top->heights, 1, 0), 0.2, 1e-7);
    assert_non_null(strstr(wr_text_get(&notes), "difference is read as subtract"));
    wr_text_fini(&notes);
    drop(&loaded);
}

/* Each layer is a picture that is read back, ten times slower with sanitizers: there are fewer there. */
#ifdef __SANITIZE_ADDRESS__
enum { MANY_LAYERS = 40 };
#else
enum { MANY_LAYERS = WR_LAYERS_MAX };
#endif

/* The composite is for other programs: it is not loaded as a layer, and does not count as one. */
static void the_composite_for_others_is_passed_over(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    wr_document_start_over(document,
                           wr_field_new(8, 8, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0.25f, NULL));
    while (document->layer_count < MANY_LAYERS)
        wr_document_insert(document, document->layer_count,
                           wr_layer_make("l", document->layers[0].heights));
    document->layers[1].opacity = 0.5f;
    document->layers[1].blend = WR_BLEND_REPLACE;
    document->active = 3;
    const WrHash before = wr_document_hash(document, "");
    WrText note = { 0 };
    WrError err = { "" };
    if (!wr_ora_save(document, "", "composite.ora", &note, &err)) fail_msg("%s", err.text);
    assert_non_null(strstr(wr_text_get(&note), "shows them the composite"));
    WrLoaded loaded = load("composite.ora", NULL);
    assert_int_equal(loaded.document->layer_count, MANY_LAYERS);
    assert_true(wr_hash_equal(before, wr_document_hash(loaded.document, "")));
    wr_text_fini(&note);
    drop(&loaded);
    wr_document_free(document);
}

/* ---- hostile files ---- */

static void expect_refused(const char *path, const char *word)
{
    WrError err = { "" };
    WrLoaded loaded = { .scene_text = (char *)"untouched" };
    WrText notes = { 0 };
    int64_t replaced = 77;
    if (wr_ora_load(path, &loaded, &replaced, &notes, &err)) fail_msg("%s was loaded", path);
    if (strncmp(err.text, path, strlen(path)) != 0 || strchr(err.text, '\n') ||
        !strstr(err.text, word))
        fail_msg("message '%s' for %s: should name it and say '%s'", err.text, path, word);
    assert_string_equal(loaded.scene_text, "untouched");
    assert_null(loaded.document);
    assert_int_equal(replaced, 77);
    assert_int_equal(notes.length, 0);
}

static void refuse_stack(const char *xml, const char *word)
{
    static const uint8_t code = 9;
    Part parts[] = { TYPE,
                     { "stack.xml", xml, 0, ZIP_CM_DEFLATE },
                     png("data/a.png", 1, 1, 1, &code) };
    write_archive("h.ora", parts, 3);
    wr_free((char *)parts[2].bytes);
    expect_refused("h.ora", word);
}

static void lists_of_layers_that_are_hostile_are_refused(void **state)
{
    (void)state;
    refuse_stack("", "damaged list of layers");
    refuse_stack("<image w='1' h='1'><stack>", "damaged list of layers, line 1");
    refuse_stack("<svg/>", "is no list of layers");
    refuse_stack("<image w='1' h='1'><stack/></image>", "has no layer");
    refuse_stack("<image w='1'><stack><layer src='data/a.png'/></stack></image>", "canvas of 1x0");
    refuse_stack("<image w='16385' h='1'><stack><layer src='data/a.png'/></stack></image>",
                 "canvas of 16385x1: each side must be 1..16384");
    refuse_stack("<image w='1e99' h='1'><stack/></image>", "w is '1e99'");
    refuse_stack("<image w='1' h='1'><stack><layer src='data/a.png' x='nan'/></stack></image>",
                 "x is 'nan'");
    refuse_stack("<image w='1' h='1'><stack><layer src='data/a.png' opacity='7'/></stack></image>",
                 "opacity is '7'");
    refuse_stack("<image w='1' h='1'><stack><layer/></stack></image>", "has no picture");
    refuse_stack("<image w='1' h='1'><stack><layer src='../../etc/passwd'/></stack></image>",
                 "has no ../../etc/passwd in it");
    refuse_stack("<image w='1' h='1'><stack><layer src='/etc/passwd'/></stack></image>",
                 "has no /etc/passwd in it");
    refuse_stack("<image w='1' h='1'><stack><layer src='stack.xml'/></stack></image>",
                 "is not a picture");
    refuse_stack("<!DOCTYPE image [<!ENTITY a 'aaaaaaaaaa'><!ENTITY b '&a;&a;&a;&a;'>]>"
                 "<image w='1' h='1'><stack><layer name='&b;' src='data/a.png'/></stack></image>",
                 "declares a document type");
    refuse_stack("<image w='1' h='1' xmlns:k='" WR_ORA_NAMESPACE "' k:version='1' k:wrap='round'>"
                 "<stack><layer src='data/a.png'/></stack></image>",
                 "wrap 'round' must be periodic");
    refuse_stack("<image w='1' h='1' xmlns:k='" WR_ORA_NAMESPACE "'><stack>"
                 "<layer src='data/a.png' k:blend='burn'/></stack></image>",
                 "blend mode 'burn'");
    refuse_stack("<image w='1' h='1' xmlns:k='" WR_ORA_NAMESPACE "'><stack>"
                 "<layer src='data/a.png' k:heights='data/a.png'/></stack></image>",
                 "must be floats, 1x1 with 1");
    WrText xml = { 0 };
    wr_text_add(&xml, "<image w='1' h='1'><stack>");
    for (int i = 0; i < 100; i++) wr_text_add(&xml, "<stack>");
    refuse_stack(xml.data, "nested more than 8 deep");
    wr_text_clear(&xml);
    wr_text_add(&xml, "<image w='1' h='1'><stack>");
    for (int i = 0; i < 300; i++) wr_text_add(&xml, "<layer src='data/a.png'/>");
    wr_text_add(&xml, "</stack></image>");
    refuse_stack(xml.data, "has more than 256 layers");
    wr_text_clear(&xml);
    for (int i = 0; i < 100000; i++) wr_text_add(&xml, "<image>");
    refuse_stack(xml.data, "nested too deep");
    wr_text_fini(&xml);
}

static void archives_that_are_hostile_are_refused(void **state)
{
    (void)state;
    static const char xml[] = "<image w='1' h='1'><stack><layer src='data/a.png'/></stack></image>";
    static char zeros[8 << 20];
    Part bomb[] = { TYPE,
                    { "stack.xml", xml, 0, 0 },
                    { "data/a.png", zeros, sizeof zeros, ZIP_CM_DEFLATE } };
    write_archive("h.ora", bomb, 3);
    expect_refused("h.ora", "unpacks from");
    Part large[] = { TYPE, { "stack.xml", zeros, 0, 0 } };
    char *spaces = malloc(17 << 20);
    memset(spaces, ' ', 17 << 20);
    large[1] = (Part){ "stack.xml", spaces, 17 << 20, ZIP_CM_STORE };
    write_archive("h.ora", large, 2);
    free(spaces);
    expect_refused("h.ora", "16.8 MB is the limit");
    Part packed[] = { TYPE, { "stack.xml", xml, 0, ZIP_CM_BZIP2 } };
    write_archive("h.ora", packed, 2);
    expect_refused("h.ora", "must be stored or deflated");
    Part other[] = { { "mimetype", "application/epub+zip", 0, 0 }, { "stack.xml", xml, 0, 0 } };
    write_archive("h.ora", other, 2);
    expect_refused("h.ora", "not an OpenRaster file");
    assert_false(wr_ora_recognise("h.ora"));
    Part bare[] = { TYPE };
    write_archive("h.ora", bare, 1);
    expect_refused("h.ora", "has no stack.xml");
    zip_t *archive = zip_open("many.ora", ZIP_CREATE, NULL);
    for (int i = 0; i < 10001; i++) {
        char name[32];
        snprintf(name, sizeof name, "%d", i);
        zip_file_add(archive, name, zip_source_buffer(archive, "", 0, 0), 0);
    }
    assert_int_equal(zip_close(archive), 0);
    expect_refused("many.ora", "10000 is the limit");
}

static void what_is_no_archive_is_refused(void **state)
{
    (void)state;
    WrError err;
    assert_true(wr_file_write("text.ora", "table 512x512\n", 14, &err));
    expect_refused("text.ora", "is not an OpenRaster file");
    assert_true(wr_file_write("empty.ora", "", 0, &err));
    expect_refused("empty.ora", "");
    expect_refused("missing.ora", "No such file");
    mkdir("folder.ora", 0777);
    expect_refused("folder.ora", "is a folder");
    assert_int_equal(mkfifo("pipe.ora", 0666), 0);
    expect_refused("pipe.ora", "is a pipe"); /* and does not wait for a writer */
    const char *paths[] = { "text.ora", "empty.ora", "missing.ora", "folder.ora", "pipe.ora" };
    for (int i = 0; i < 5; i++) assert_false(wr_ora_recognise(paths[i]));
}

static void damaged_files_never_crash_and_leave_nothing_behind(void **state)
{
    (void)state;
    char *bytes;
    size_t length;
    WrError err;
    WrDocument *document = make_document(20, 9);
    save(document, "surface torus\n", "good.ora");
    assert_true(wr_file_read("good.ora", 1 << 24, &bytes, &length, &err));
    for (size_t cut = 1; cut <= 20; cut++) {
        assert_true(wr_file_write("cut.ora", bytes, length * cut / 21, &err));
        expect_refused("cut.ora", "");
    }
    TestRandom random = { 8 };
    for (int n = 0; n < 60; n++) {
        size_t at = (size_t)(test_random_u64(&random) % length);
        char was = bytes[at];
        bytes[at] = (char)test_random_u64(&random);
        assert_true(wr_file_write("bad.ora", bytes, length, &err));
        WrLoaded loaded = { 0 };
        int64_t replaced;
        err.text[0] = '\0';
        if (wr_ora_load("bad.ora", &loaded, &replaced, NULL, &err)) drop(&loaded);
        else assert_true(strncmp(err.text, "bad.ora: ", 9) == 0);
        bytes[at] = was;
    }
    wr_free(bytes);
    wr_document_free(document);
}

#define NEXT_VERSION "11"

static void a_newer_version_loads_and_says_so(void **state)
{
    (void)state;
    static const char xml[] =
        "<image w='1' h='1' xmlns:k='" WR_ORA_NAMESPACE "' k:version='" NEXT_VERSION "'><stack>"
        "<layer src='data/a.png' k:blend='burn' k:glow='3'/></stack></image>";
    static const uint8_t code = 255;
    Part parts[] = { TYPE,
                     { "stack.xml", xml, 0, ZIP_CM_DEFLATE },
                     png("data/a.png", 1, 1, 1, &code) };
    write_archive("new.ora", parts, 3);
    wr_free((char *)parts[2].bytes);
    WrText notes = { 0 };
    WrLoaded loaded = load("new.ora", &notes);
    assert_true(loaded.newer_version == WR_ORA_VERSION + 1.0);
    assert_non_null(strstr(wr_text_get(&notes), "its blend mode is not known here"));
    assert_true(wr_field_get(loaded.document->layers[0].heights, 0, 0) == 1.0f);
    wr_text_fini(&notes);
    drop(&loaded);
}

/* ---- saving fails cleanly ---- */

static int files_here(void)
{
    FILE *list = popen("ls -A | wc -l", "r");
    int count = -1;
    assert_int_equal(fscanf(list, "%d", &count), 1);
    pclose(list);
    return count;
}

static void a_failed_save_leaves_the_old_file_and_nothing_else(void **state)
{
    (void)state;
    WrDocument *document = make_document(30, 20);
    WrError err = { "" };
    mkdir("target.ora", 0777);
    int before = files_here();
    assert_false(wr_ora_save(document, "", "target.ora", NULL, &err));
    assert_non_null(strstr(err.text, "is a folder"));
    assert_false(wr_ora_save(document, "", "nowhere/a.ora", NULL, &err));
    assert_non_null(strstr(err.text, "folder does not exist"));
    assert_int_equal(files_here(), before);
    /* A device that is always full simulates a full disk, if mounting is possible. */
    mkdir("disk", 0777);
    if (system("mount -t tmpfs -o size=16k tmpfs disk 2>/dev/null") == 0) {
        assert_true(wr_file_write("disk/a.ora", "precious", 8, &err));
        bool saved = wr_ora_save(document, "", "disk/a.ora", NULL, &err);
        char *bytes;
        size_t length;
        assert_true(wr_file_read("disk/a.ora", 100, &bytes, &length, NULL));
        int left = system("test $(ls -A disk | wc -l) = 1");
        assert_int_equal(system("umount disk"), 0);
        assert_false(saved);
        assert_string_equal(bytes, "precious");
        wr_free(bytes);
        assert_int_equal(left, 0);
        if (strncmp(err.text, "disk/a.ora: cannot be written", 29) != 0) fail_msg("%s", err.text);
    }
    wr_document_free(document);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_was_saved_comes_back_bit_for_bit),
        cmocka_unit_test(an_empty_document_stays_as_small_as_it_is),
        cmocka_unit_test(the_colour_picture_travels_along),
        cmocka_unit_test(the_same_document_gives_the_same_bytes_a_while_later),
        cmocka_unit_test(the_archive_is_laid_out_as_the_format_wants),
        cmocka_unit_test(a_filters_preview_is_transparent),
        cmocka_unit_test(previews_show_heights_over_the_stated_range),
        cmocka_unit_test(a_strangers_layers_become_heights_and_coverage),
        cmocka_unit_test(a_file_of_ours_from_another_program_keeps_its_pictures),
        cmocka_unit_test(difference_comes_back_as_subtract),
        cmocka_unit_test(the_composite_for_others_is_passed_over),
        cmocka_unit_test(lists_of_layers_that_are_hostile_are_refused),
        cmocka_unit_test(archives_that_are_hostile_are_refused),
        cmocka_unit_test(what_is_no_archive_is_refused),
        cmocka_unit_test(damaged_files_never_crash_and_leave_nothing_behind),
        cmocka_unit_test(a_newer_version_loads_and_says_so),
        cmocka_unit_test(a_failed_save_leaves_the_old_file_and_nothing_else),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
