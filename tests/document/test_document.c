/* Documents: layers and their composite, snapshots, hashes, the file, heights from pictures. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/exactmath.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/pool.h"
#include "document/document.h"
#include "document/document_file.h"
#include "field/field.h"
#include "image/image.h"
#include "scene/scene.h"

#include <sys/resource.h>
#include <unistd.h>

static WrField *random_field(int width, int height, WrWrap wrap_u, WrWrap wrap_v, uint64_t seed)
{
    TestRandom random = { seed };
    WrField *field = wr_field_new(width, height, wrap_u, wrap_v, 0.0f, NULL);
    assert_non_null(field);
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++)
            wr_field_set(field, i, j, (float)(test_random(&random) * 1e3 - 500));
    return field;
}

/* A document of `count` layers named by `names`, of random heights. */
static WrDocument *make_document(int count, const char *const *names, int width, int height,
                                 WrWrap wrap_u, WrWrap wrap_v)
{
    WrDocument *document = wr_document_new();
    wr_free(document->layers[0].name);
    wr_field_free(document->layers[0].heights);
    wr_free(document->layers);
    document->layers = wr_alloc((size_t)count, sizeof *document->layers);
    document->layer_count = count;
    for (int i = 0; i < count; i++) {
        WrField *field = random_field(width, height, wrap_u, wrap_v, (uint64_t)(i + 11));
        document->layers[i] = (WrLayer){
            .name = wr_strdup(names[i]), .heights = field, .opacity = 1.0f, .visible = true
        };
    }
    return document;
}

static void an_empty_document_is_a_flat_periodic_table_of_one_layer(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    const WrField *f = wr_document_field(document);
    float low, high;
    assert_int_equal(document->layer_count, 1);
    assert_string_equal(document->layers[0].name, "base");
    assert_int_equal(wr_field_width(f) * 1000 + wr_field_height(f), 512512);
    assert_true(wr_field_wrap_u(f) == WR_WRAP_PERIODIC && wr_field_wrap_v(f) == WR_WRAP_PERIODIC);
    wr_field_range(f, &low, &high);
    assert_true(low == 0.0f && high == 0.0f);
    wr_document_free(document);
    wr_document_free(NULL);
}

static void edits_after_a_snapshot_do_not_show_in_it(void **state)
{
    (void)state;
    const char *names[] = { "a", "b" };
    WrDocument *document = make_document(2, names, 100, 70, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    WrHash before = wr_document_hash(document, "");
    wr_document_field(document);
    WrDocument *snapshot = wr_document_share(document);
    wr_field_set(document->layers[1].heights, 99, 69, 1e6f);
    assert_true(wr_hash_equal(wr_document_hash(snapshot, ""), before));
    assert_false(wr_hash_equal(wr_document_hash(document, ""), before));
    assert_true(wr_field_get(wr_document_field(snapshot), 99, 69) < 1e4f);
    assert_true(wr_field_get(wr_document_field(document), 99, 69) > 9e5f);
    wr_document_free(document);
    assert_true(wr_field_get(wr_document_field(snapshot), 99, 69) < 1e4f);
    wr_document_free(snapshot);
}

static void the_hash_tells_heights_names_layers_and_scenes_apart(void **state)
{
    (void)state;
    const char *names[] = { "a", "b" }, *other[] = { "a", "c" };
    WrHash hashes[5];
    WrDocument *document = make_document(2, names, 30, 20, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    hashes[0] = wr_document_hash(document, "surface torus");
    hashes[1] = wr_document_hash(document, "surface plane");
    float old = wr_field_get(document->layers[1].heights, 3, 4);
    wr_field_set(document->layers[1].heights, 3, 4, old + 1);
    hashes[2] = wr_document_hash(document, "surface torus");
    /* and the same contents have the same hash */
    wr_field_set(document->layers[1].heights, 3, 4, old);
    assert_true(wr_hash_equal(hashes[0], wr_document_hash(document, "surface torus")));
    wr_document_free(document);
    document = make_document(2, other, 30, 20, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    hashes[3] = wr_document_hash(document, "surface torus");
    wr_document_free(document);
    document = make_document(1, names, 30, 20, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    hashes[4] = wr_document_hash(document, "surface torus");
    wr_document_free(document);
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < i; k++) assert_false(wr_hash_equal(hashes[i], hashes[k]));
}

/* Layers that are added: each sum is rounded once to float, from the bottom up. */
static void check_sum(const WrDocument *document)
{
    const WrField *sum = wr_document_field(document);
    for (int j = 0; j < wr_field_height(sum); j++)
        for (int i = 0; i < wr_field_width(sum); i++) {
            float want = 0.0f;
            for (int k = 0; k < document->layer_count; k++) {
                double exact = (double)want + wr_field_get(document->layers[k].heights, i, j);
                want = (float)(exact > 3.4028234663852886e38 ? 3.4028234663852886e38 : exact);
            }
            assert_true(wr_field_get(sum, i, j) == want);
        }
}

static void f_is_the_sum_of_the_layers_after_every_kind_of_edit(void **state)
{
    (void)state;
    const char *names[] = { "a", "b", "c" };
    WrDocument *document = make_document(3, names, 150, 70, WR_WRAP_PERIODIC, WR_WRAP_CLAMP);
    check_sum(document);
    assert_true(wr_field_wrap_v(wr_document_field(document)) == WR_WRAP_CLAMP);
    uint64_t key = wr_field_key(wr_document_field(document));
    assert_true(wr_field_key(wr_document_field(document)) == key); /* nothing changed: same table */
    wr_field_set(document->layers[2].heights, 140, 3, 7.0f);
    wr_field_set(document->layers[0].heights, 140, 3, 0.5f);
    check_sum(document);
    wr_field_fill(document->layers[1].heights, 2.5f);
    check_sum(document);
    wr_field_free(
        document->layers[0].heights); /* a command may replace a table, by another size too */
    document->layers[0].heights = random_field(150, 70, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, 77);
    check_sum(document);
    for (int k = 0; k < 3; k++) {
        wr_field_free(document->layers[k].heights);
        document->layers[k].heights = random_field(5, 3, WR_WRAP_CLAMP, WR_WRAP_CLAMP, (uint64_t)k);
    }
    check_sum(document);
    for (int k = 0; k < 3; k++)
        wr_field_fill(document->layers[k].heights, 1.0f); /* no tiles at all */
    check_sum(document);
    wr_field_fill(document->layers[1].heights, 4.0f);
    check_sum(document);
    wr_field_set(document->layers[0].heights, 0, 0, 3e38f);
    wr_field_set(document->layers[1].heights, 0, 0, 3e38f);
    assert_true(isfinite(wr_field_get(wr_document_field(document), 0, 0)));
    wr_document_free(document);
}

/* ---- the file ---- */

static void read_bytes(const char *path, char **bytes, size_t *length)
{
    WrError err;
    if (!wr_file_read(path, 1 << 28, bytes, length, &err)) fail_msg("%s", err.text);
}

static void check_save_load_save(const WrDocument *document, const char *scene)
{
    WrError err = { "" };
    WrLoaded loaded;
    int64_t replaced = -1;
    if (!wr_document_save(document, scene, "one.exr", NULL, &err)) fail_msg("%s", err.text);
    assert_true(wr_document_recognise("one.exr"));
    if (!wr_document_load("one.exr", &loaded, &replaced, &err)) fail_msg("%s", err.text);
    assert_int_equal(replaced, 0);
    assert_string_equal(loaded.scene_text, scene);
    assert_int_equal(loaded.document->layer_count, document->layer_count);
    for (int i = 0; i < document->layer_count; i++)
        assert_string_equal(loaded.document->layers[i].name, document->layers[i].name);
    assert_true(wr_hash_equal(wr_document_hash(document, scene),
                              wr_document_hash(loaded.document, loaded.scene_text)));
    if (loaded.pictures[0][WR_OBJECT_COLOUR]) { /* the session puts it back into the scene */
        WrScene *with = wr_scene_clone(loaded.document->scene);
        with->colour = wr_image_share(loaded.pictures[0][WR_OBJECT_COLOUR]);
        wr_scene_free(loaded.document->scene);
        loaded.document->scene = with;
    }
    WrPool *pool = wr_pool_new(3);
    assert_true(wr_document_save(loaded.document, loaded.scene_text, "two.exr", pool, &err));
    wr_pool_free(pool);
    char *one, *two;
    size_t length_one, length_two;
    read_bytes("one.exr", &one, &length_one);
    read_bytes("two.exr", &two, &length_two);
    assert_int_equal(length_one, length_two);
    assert_memory_equal(one, two, length_one);
    wr_free(one);
    wr_free(two);
    wr_image_free(loaded.pictures[0][WR_OBJECT_COLOUR]);
    wr_free(loaded.scene_text);
    wr_document_free(loaded.document);
}

static void hc53_save_load_save_gives_the_same_heights_and_bytes(void **state)
{
    (void)state;
    const struct {
        int width, height;
        WrWrap u, v;
    } tables[] = { { 1, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC },
                   { 1, 130, WR_WRAP_CLAMP, WR_WRAP_PERIODIC },
                   { 200, 3, WR_WRAP_PERIODIC, WR_WRAP_CLAMP },
                   { 100, 150, WR_WRAP_CLAMP, WR_WRAP_CLAMP } };
    const char *names[] = { "base", "", "base", "Mauer \xc3\xbc \"x\"", "base" };
    for (int i = 0; i < 4; i++) {
        WrDocument *document = make_document(1 + i, names, tables[i].width, tables[i].height,
                                             tables[i].u, tables[i].v);
        check_save_load_save(document, "surface torus R=1 r=0.35\nbump mode=blinn\n");
        check_save_load_save(document, "");
        wr_document_free(document);
    }
}

static void a_colour_picture_of_any_size_travels_along(void **state)
{
    (void)state;
    const char *names[] = { "base" };
    for (int channels = 1; channels <= 4; channels += 3) {
        WrDocument *document = make_document(1, names, 20, 30, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
        WrScene *scene = wr_scene_clone(document->scene);
        scene->colour = wr_image_new(77, 9, channels, NULL);
        for (int i = 0; i < 77 * 9 * channels; i++) scene->colour->data[i] = (float)i * 0.25f;
        wr_scene_free(document->scene);
        document->scene = scene;
        check_save_load_save(document, "colour \"c.png\"\n");
        WrLoaded loaded;
        int64_t replaced;
        assert_true(wr_document_load("one.exr", &loaded, &replaced, NULL));
        assert_int_equal(loaded.pictures[0][WR_OBJECT_COLOUR]->width * 100 +
                             loaded.pictures[0][WR_OBJECT_COLOUR]->height,
                         7709);
        for (int i = 0; i < 77 * 9; i++)
            for (int c = 0; c < 3; c++)
                assert_true(loaded.pictures[0][WR_OBJECT_COLOUR]->data[3 * i + c] ==
                            scene->colour->data[channels * i + (channels == 1 ? 0 : c)]);
        wr_image_free(loaded.pictures[0][WR_OBJECT_COLOUR]);
        wr_free(loaded.scene_text);
        wr_document_free(loaded.document);
        wr_document_free(document);
    }
}

static void any_reader_of_exr_sees_the_relief_first(void **state)
{
    (void)state;
    const char *names[] = { "a", "b" };
    WrDocument *document = make_document(2, names, 90, 40, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    WrError err;
    assert_true(wr_document_save(document, "", "relief.exr", NULL, &err));
    WrImage *image = wr_image_read("relief.exr", &err);
    assert_non_null(image);
    const WrField *f = wr_document_field(document);
    for (int i = 0; i < 90 * 40; i++)
        assert_true(image->data[i] == wr_field_get(f, i % 90, i / 90));
    wr_image_free(image);
    wr_document_free(document);
}

static void an_almost_empty_large_table_stays_small_in_memory(void **state)
{
    (void)state;
    WrDocument *document = wr_document_new();
    wr_field_free(document->layers[0].heights);
    document->layers[0].heights =
        wr_field_new(4096, 4096, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    wr_field_set(document->layers[0].heights, 4000, 5, 1.0f);
    WrError err;
    struct rusage before, after;
    WrLoaded loaded;
    int64_t replaced;
    getrusage(RUSAGE_SELF, &before);
    assert_true(wr_document_save(document, "", "large.exr", NULL, &err));
    assert_true(wr_document_load("large.exr", &loaded, &replaced, &err));
    getrusage(RUSAGE_SELF, &after);
#ifndef __SANITIZE_ADDRESS__ /* which delays the reuse of freed memory */
    /* 64 MB a copy of the table; strips and the library's buffers take a few */
    assert_true(after.ru_maxrss - before.ru_maxrss < 32 * 1024);
#endif
    assert_true(wr_field_bytes(loaded.document->layers[0].heights) < 1 << 20);
    assert_true(wr_field_get(loaded.document->layers[0].heights, 4000, 5) == 1.0f);
    wr_free(loaded.scene_text);
    wr_document_free(loaded.document);
    wr_document_free(document);
}

/* ---- invalid documents ---- */

typedef struct Part {
    const char *name;
    int width, height, channels;
    float value;
} Part;

static bool part_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)y;
    (void)err;
    const Part *part = ctx;
    for (int i = 0; i < rows * part->width * part->channels; i++) ((float *)out)[i] = part->value;
    return true;
}

static void write_parts(const char *path, const char *version, const char *wrap, Part *parts,
                        int count)
{
    WrImageAttribute attributes[] = { { "wrinkle:version", version }, { "wrinkle:wrap", wrap } };
    WrImageOut outs[4];
    WrError err = { "" };
    for (int i = 0; i < count; i++)
        outs[i] = (WrImageOut){ .width = parts[i].width,
                                .height = parts[i].height,
                                .channels = parts[i].channels,
                                .type = WR_PIXEL_F32,
                                .part_name = parts[i].name,
                                .data = true,
                                .attributes = attributes,
                                .attribute_count = i == 0 ? 2 : 0,
                                .rows = part_rows,
                                .ctx = &parts[i] };
    if (!wr_image_write(path, outs, count, &err)) fail_msg("%s", err.text);
}

static void check_not_loaded(const char *path, const char *word)
{
    WrError err = { "" };
    WrLoaded loaded = { .scene_text = "untouched" };
    int64_t replaced = 42;
    assert_false(wr_document_load(path, &loaded, &replaced, &err));
    assert_true(loaded.document == NULL && replaced == 42);
    assert_string_equal(loaded.scene_text, "untouched");
    if (!strstr(err.text, word) || !strstr(err.text, path))
        fail_msg("message '%s': no '%s'", err.text, word);
}

static void strange_documents_are_refused_with_a_reason(void **state)
{
    (void)state;
    Part f = { "F", 8, 6, 1, 0 }, layer = { "layer:base", 8, 6, 1, 2 };
    Part good[2] = { f, layer };
    write_parts("v.exr", "one", "periodic", good, 2);
    check_not_loaded("v.exr", "document version 'one'");
    write_parts("v0.exr", "0.5", "periodic", good, 2);
    check_not_loaded("v0.exr", "document version '0.5'");
    write_parts("wrap.exr", "1", "mirror", good, 2);
    check_not_loaded("wrap.exr", "'mirror' must be periodic, clamp-u, clamp-v or clamp");
    write_parts("bare.exr", "1", "periodic", good, 1);
    check_not_loaded("bare.exr", "has no layer");
    Part size[2] = { f, { "layer:base", 8, 7, 1, 2 } };
    write_parts("size.exr", "1", "periodic", size, 2);
    check_not_loaded("size.exr", "is 8x7 with 1 channels; F is 8x6");
    Part channels[2] = { f, { "layer:base", 8, 6, 2, 2 } };
    write_parts("channels.exr", "1", "periodic", channels, 2);
    check_not_loaded("channels.exr", "with 2 channels");
    Part stranger[3] = { f, layer, { "mask", 8, 6, 1, 2 } };
    write_parts("stranger.exr", "1", "periodic", stranger, 3);
    check_not_loaded("stranger.exr", "part 'mask' does not belong");
    Part early[3] = { f, { "colour", 8, 6, 3, 2 }, layer };
    write_parts("early.exr", "1", "periodic", early, 3);
    check_not_loaded("early.exr", "part 'layer:base' does not belong"); /* after the colour */
    Part grey[3] = { f, layer, { "colour", 8, 6, 1, 2 } };
    write_parts("grey.exr", "1", "periodic", grey, 3);
    check_not_loaded("grey.exr", "colour picture has 1 channels");
}

static void heights_that_are_not_finite_load_as_zero_and_are_counted(void **state)
{
    (void)state;
    Part parts[2] = { { "F", 70, 66, 1, 0 }, { "layer:base", 70, 66, 1, NAN } };
    WrLoaded loaded;
    int64_t replaced = 0;
    write_parts("nan.exr", "1", "clamp-u", parts, 2);
    assert_true(wr_document_load("nan.exr", &loaded, &replaced, NULL));
    assert_int_equal(replaced, 70 * 66);
    float low, high;
    wr_field_range(loaded.document->layers[0].heights, &low, &high);
    assert_true(low == 0.0f && high == 0.0f);
    assert_true(wr_field_wrap_u(loaded.document->layers[0].heights) == WR_WRAP_CLAMP);
    assert_string_equal(loaded.scene_text, "");
    wr_free(loaded.scene_text);
    wr_document_free(loaded.document);
}

static void truncated_and_foreign_files_are_not_documents(void **state)
{
    (void)state;
    WrError err;
    char *bytes;
    size_t length;
    const char *names[] = { "base" };
    WrDocument *document = make_document(1, names, 60, 60, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
    assert_true(wr_document_save(document, "", "whole.exr", NULL, &err));
    read_bytes("whole.exr", &bytes, &length);
    for (int cut = 1; cut < 20; cut++) {
        assert_true(wr_file_write("cut.exr", bytes, length * (size_t)cut / 20, &err));
        check_not_loaded("cut.exr", "truncated");
    }
    wr_free(bytes);
    wr_document_free(document);
    float pixel = 1;
    assert_true(wr_image_write_pixels("plain.exr", 1, 1, 1, WR_PIXEL_F32, true, &pixel, &err));
    assert_false(wr_document_recognise("plain.exr"));
    check_not_loaded("plain.exr", "is not a Wrinkle document");
    assert_true(wr_file_write("text.wrinkle", "table 8x8\n", 10, &err));
    assert_false(wr_document_recognise("text.wrinkle"));
    assert_false(wr_document_recognise("missing"));
    assert_false(wr_document_recognise("."));
}

/* A document of one layer, and of several parts, each with less space than needed: from a third less down to a single
   byte, where only the table at the end is missing. */
static void a_full_disk_keeps_the_old_document(void **state)
{
    const char *names[] = { "base", "more" };
    for (int layers = 1; layers <= 2; layers++) {
        WrDocument *document =
            make_document(layers, names, 100, 100, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC);
        WrError err = { "" };
        char *before, *after;
        size_t length, length_after;
        struct rlimit old, small;
        assert_true(wr_document_save(document, "", "kept.exr", NULL, &err));
        read_bytes("kept.exr", &before, &length);
        const size_t missing[] = { length, length / 3, 4096, 500, 100, 9, 1, 0 };
        getrlimit(RLIMIT_FSIZE, &old);
        for (size_t i = 0; i < sizeof missing / sizeof *missing; i++) {
            small = old;
            small.rlim_cur = length - missing[i];
            setrlimit(RLIMIT_FSIZE, &small);
            bool ok = wr_document_save(document, "", "kept.exr", NULL, &err);
            setrlimit(RLIMIT_FSIZE, &old);
            if (ok != (missing[i] == 0)) fail_msg("%zu bytes are missing", missing[i]);
            char said[160];
            snprintf(said, sizeof said,
                     "kept.exr: cannot be written (File too large: at most %zu bytes are allowed "
                     "here (ulimit -f))",
                     length - missing[i]);
            if (!ok) assert_string_equal(err.text, said);
            read_bytes("kept.exr", &after, &length_after);
            assert_int_equal(length, length_after);
            assert_memory_equal(before, after, length);
            wr_free(after);
        }
        wr_free(before);
        wr_document_free(document);
        assert_int_equal(system("test -z \"$(ls -A | grep part)\""), 0);
    }
    (void)state;
}

/* ---- heights from pictures ---- */

static WrImage *random_image(int width, int height, int channels, uint64_t seed)
{
    TestRandom random = { seed };
    WrImage *image = wr_image_new(width, height, channels, NULL);
    for (int i = 0; i < width * height * channels; i++)
        image->data[i] = (float)test_random(&random);
    return image;
}

static void pictures_of_the_tables_size_keep_their_values(void **state)
{
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        WrImage *image = random_image(70, 65, channels, 5);
        WrField *field = wr_import_heights(image, 0, 0, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, NULL);
        assert_int_equal(wr_field_width(field) * 100 + wr_field_height(field), 7065);
        assert_true(wr_field_wrap_u(field) == WR_WRAP_CLAMP);
        for (int i = 0; i < 70 * 65; i++)
            assert_true(wr_field_get(field, i % 70, i / 70) ==
                        wr_image_luma(image->data + i * channels, channels));
        wr_field_free(field);
        wr_image_free(image);
    }
}

static void shrinking_by_whole_numbers_takes_means_of_blocks(void **state)
{
    (void)state;
    WrImage *image = random_image(60, 28, 1, 6);
    WrField *field = wr_import_heights(image, 20, 7, WR_WRAP_PERIODIC, WR_WRAP_CLAMP, NULL);
    for (int j = 0; j < 7; j++)
        for (int i = 0; i < 20; i++) {
            double sum = 0;
            for (int y = 0; y < 4; y++)
                for (int x = 0; x < 3; x++) sum += image->data[(4 * j + y) * 60 + 3 * i + x];
            assert_near(wr_field_get(field, i, j), sum / 12,
                        1e-7); /* float rounding of values below 1 */
        }
    wr_field_free(field);
    wr_image_free(image);
}

static double mean(const WrField *field)
{
    double sum = 0;
    int w = wr_field_width(field), h = wr_field_height(field);
    for (int j = 0; j < h; j++)
        for (int i = 0; i < w; i++) sum += wr_field_get(field, i, j);
    return sum / w / h;
}

static void shrinking_by_any_ratio_keeps_the_mean(void **state)
{
    (void)state;
    WrImage *image = random_image(101, 67, 1, 7);
    WrField *whole = wr_import_heights(image, 0, 0, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, NULL);
    const int sizes[][2] = { { 100, 66 }, { 64, 64 }, { 37, 11 }, { 1, 1 }, { 101, 1 } };
    for (int k = 0; k < 5; k++) {
        WrField *small = wr_import_heights(image, sizes[k][0], sizes[k][1], WR_WRAP_PERIODIC,
                                           WR_WRAP_PERIODIC, NULL);
        assert_near(mean(small), mean(whole), 1e-7);
        wr_field_free(small);
    }
    wr_field_free(whole);
    wr_image_free(image);
}

static void growing_threefold_keeps_the_samples_and_wraps_at_the_seam(void **state)
{
    (void)state;
    WrImage *image = random_image(10, 7, 1, 8), *rolled = wr_image_new(10, 7, 1, NULL);
    for (int i = 0; i < 70; i++) rolled->data[i] = image->data[i / 10 * 10 + (i + 1) % 10];
    WrField *a = wr_import_heights(image, 30, 21, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, NULL);
    WrField *b = wr_import_heights(rolled, 30, 21, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, NULL);
    for (int j = 0; j < 7; j++)
        for (int i = 0; i < 10; i++)
            assert_true(wr_field_get(a, 3 * i + 1, 3 * j + 1) == image->data[10 * j + i]);
    for (int j = 0; j < 21; j++) /* the same picture with another origin: no seam */
        for (int i = 0; i < 30; i++)
            assert_true(wr_field_get(b, i, j) == wr_field_get(a, (i + 3) % 30, j));
    wr_field_free(a);
    wr_field_free(b);
    wr_image_free(image);
    wr_image_free(rolled);
}

static double growing_error(int n)
{
    WrImage *image = wr_image_new(n, 2, 1, NULL);
    for (int i = 0; i < 2 * n; i++) image->data[i] = (float)sin(2 * WR_PI * (i % n + 0.5) / n);
    WrField *field = wr_import_heights(image, 8 * n, 2, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, NULL);
    double worst = 0;
    for (int i = 0; i < 8 * n; i++)
        worst = fmax(worst, fabs(wr_field_get(field, i, 0) - sin(2 * WR_PI * (i + 0.5) / (8 * n))));
    wr_field_free(field);
    wr_image_free(image);
    return worst;
}

static void growing_converges_with_third_order_and_no_shift(void **state)
{
    (void)state;
    double order = log2(growing_error(16) / growing_error(32));
    assert_near(order, 3.0, 0.3);
}

static void clamped_edges_do_not_see_the_other_side(void **state)
{
    (void)state;
    WrImage *image = wr_image_new(8, 1, 1, NULL);
    image->data[7] = 1.0f;
    WrField *clamped = wr_import_heights(image, 32, 1, WR_WRAP_CLAMP, WR_WRAP_PERIODIC, NULL);
    WrField *wrapped = wr_import_heights(image, 32, 1, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, NULL);
    assert_true(wr_field_get(clamped, 0, 0) == 0.0f);
    assert_true(wr_field_get(wrapped, 0, 0) > 0.1f);
    assert_true(wr_field_get(clamped, 31, 0) > 0.99f);
    wr_field_free(clamped);
    wr_field_free(wrapped);
    wr_image_free(image);
}

static void imports_out_of_range_are_errors(void **state)
{
    (void)state;
    WrError err = { "" };
    WrImage *image = wr_image_new(4, 4, 1, NULL);
    assert_null(wr_import_heights(image, 0, 5, WR_WRAP_CLAMP, WR_WRAP_CLAMP, &err));
    assert_true(err.text[0] != '\0');
    assert_null(wr_import_heights(image, 16385, 5, WR_WRAP_CLAMP, WR_WRAP_CLAMP, &err));
    assert_null(wr_import_heights(image, -1, -1, WR_WRAP_CLAMP, WR_WRAP_CLAMP, &err));
    wr_image_free(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_empty_document_is_a_flat_periodic_table_of_one_layer),
        cmocka_unit_test(edits_after_a_snapshot_do_not_show_in_it),
        cmocka_unit_test(the_hash_tells_heights_names_layers_and_scenes_apart),
        cmocka_unit_test(f_is_the_sum_of_the_layers_after_every_kind_of_edit),
        cmocka_unit_test(hc53_save_load_save_gives_the_same_heights_and_bytes),
        cmocka_unit_test(a_colour_picture_of_any_size_travels_along),
        cmocka_unit_test(any_reader_of_exr_sees_the_relief_first),
        cmocka_unit_test(an_almost_empty_large_table_stays_small_in_memory),
        cmocka_unit_test(strange_documents_are_refused_with_a_reason),
        cmocka_unit_test(heights_that_are_not_finite_load_as_zero_and_are_counted),
        cmocka_unit_test(truncated_and_foreign_files_are_not_documents),
        cmocka_unit_test(a_full_disk_keeps_the_old_document),
        cmocka_unit_test(pictures_of_the_tables_size_keep_their_values),
        cmocka_unit_test(shrinking_by_whole_numbers_takes_means_of_blocks),
        cmocka_unit_test(shrinking_by_any_ratio_keeps_the_mean),
        cmocka_unit_test(growing_threefold_keeps_the_samples_and_wraps_at_the_seam),
        cmocka_unit_test(growing_converges_with_third_order_and_no_shift),
        cmocka_unit_test(clamped_edges_do_not_see_the_other_side),
        cmocka_unit_test(imports_out_of_range_are_errors),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
