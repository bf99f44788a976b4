/* OpenRaster files of the program in other programs: an independent reader of the format (layer list, pictures,
   composite-ops) computes the same picture; no program requests a colour profile. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "document/blend.h"
#include "document/document.h"
#include "document/ora.h"
#include "field/field.h"
#include "image/image.h"
#include "image/normal_encoding.h"

#include <zip.h>
#include <zlib.h>

#define WIDTH 90
#define HEIGHT 70
#define COUNT (WIDTH * HEIGHT)

/* ---- the other program ---- */

static char *entry(zip_t *archive, const char *name, size_t *length)
{
    zip_stat_t is;
    assert_int_equal(zip_stat(archive, name, 0, &is), 0);
    char *bytes = calloc(1, is.size + 1);
    zip_file_t *file = zip_fopen(archive, name, 0);
    assert_int_equal(zip_fread(file, bytes, is.size), is.size);
    zip_fclose(file);
    *length = is.size;
    return bytes;
}

static WrImage *picture(zip_t *archive, const char *name)
{
    size_t length;
    WrError err = { "" };
    char *bytes = entry(archive, name, &length);
    WrImage *image = wr_image_read_bytes(name, bytes, length, &err);
    if (!image) fail_msg("%s", err.text);
    assert_int_equal(image->channels, 4);
    free(bytes);
    return image;
}

/* The value of ` name="..."` of an element. */
static void attribute(const char *element, const char *name, char *value, size_t size)
{
    char head[40];
    snprintf(head, sizeof head, " %s=\"", name);
    const char *at = strstr(element, head), *end = strchr(element, '>');
    if (!at || at > end) fail_msg("no %s in %.60s", name, element);
    at += strlen(head);
    snprintf(value, size, "%.*s", (int)strcspn(at, "\""), at);
}

/* Blend behaviour of another program, and layers hidden by its user. */
typedef struct Stranger {
    /* of the scale for blending greys: 1, codes unchanged; 2.2, linear light, as in MyPaint */
    double gamma;
    bool hides_composite;
} Stranger;

/* Compositing and Blending Level 1, grey; b premultiplied. */
static void join(const char *operation, double s, double alpha, double *b, double *b_alpha)
{
    double under = *b_alpha > 0 ? *b / *b_alpha : 0, both = alpha * *b_alpha, mixed = s;
    if (strcmp(operation, "svg:plus") == 0) {
        *b = fmin(1, *b + alpha * s);
        *b_alpha = fmin(1, *b_alpha + alpha);
        return;
    }
    if (strcmp(operation, "svg:lighten") == 0) mixed = fmax(s, under);
    else if (strcmp(operation, "svg:darken") == 0) mixed = fmin(s, under);
    else if (strcmp(operation, "svg:multiply") == 0) mixed = s * under;
    else if (strcmp(operation, "svg:difference") == 0) mixed = fabs(s - under);
    else if (strcmp(operation, "svg:src-over") != 0) fail_msg("unknown: %s", operation);
    *b = alpha * (1 - *b_alpha) * s + both * mixed + (1 - alpha) * *b;
    *b_alpha = alpha + (1 - alpha) * *b_alpha;
}

static bool is_composite(const char *layer)
{
    const char *at = strstr(layer, " wrinkle:composite=\"on\"");
    return at && at < strchr(layer, '>');
}

static bool begins(const char *at, const char *with)
{
    return strncmp(at, with, strlen(with)) == 0;
}

/* The element after a layer, or after a group with its layers. */
static const char *behind(const char *element)
{
    int open = 0;
    do {
        open += begins(element, "<stack") - begins(element, "</stack");
        element = strchr(element + 1, '<');
    } while (open > 0);
    return element;
}

/* Composite the elements below the topmost one first; a group on nothing. Returns the number of visible elements. */
static int compose(zip_t *archive, const char *top, Stranger by, double *grey, double *alpha)
{
    char src[40], operation[40], opacity[40], visibility[40];
    if (begins(top, "</stack")) return 0;
    const bool group = begins(top, "<stack");
    int shown = compose(archive, behind(top), by, grey, alpha);
    attribute(top, "composite-op", operation, sizeof operation);
    attribute(top, "opacity", opacity, sizeof opacity);
    attribute(top, "visibility", visibility, sizeof visibility);
    if (strcmp(visibility, "hidden") == 0) return shown;
    if (by.hides_composite && is_composite(top)) return shown;
    if (group) {
        char isolation[40];
        attribute(top, "isolation", isolation, sizeof isolation);
        assert_string_equal(isolation, "isolate");
        double *own = calloc(COUNT, sizeof *own), *own_alpha = calloc(COUNT, sizeof *own);
        compose(archive, strchr(top + 1, '<'), by, own, own_alpha);
        for (int i = 0; i < COUNT; i++)
            join(operation, own_alpha[i] > 0 ? own[i] / own_alpha[i] : 0,
                 own_alpha[i] * atof(opacity), &grey[i], &alpha[i]);
        free(own);
        free(own_alpha);
        return shown + 1;
    }
    attribute(top, "src", src, sizeof src);
    WrImage *image = picture(archive, src);
    for (int i = 0; i < COUNT; i++)
        join(operation, pow(image->data[4 * i], by.gamma), image->data[4 * i + 3] * atof(opacity),
             &grey[i], &alpha[i]);
    wr_image_free(image);
    return shown + 1;
}

/* Some programs show nothing for an addition to an empty picture. */
static void check_lowest(const char *top)
{
    char operation[40], opacity[40], visibility[40];
    const char *lowest = NULL;
    for (const char *at = top; !begins(at, "</stack"); at = behind(at)) {
        attribute(at, "visibility", visibility, sizeof visibility);
        if (strcmp(visibility, "visible") == 0) lowest = at;
    }
    if (!lowest || begins(lowest, "<stack")) return; /* a composite lies over it */
    attribute(lowest, "composite-op", operation, sizeof operation);
    attribute(lowest, "opacity", opacity, sizeof opacity);
    assert_string_equal(operation, "svg:src-over");
    assert_true(atof(opacity) == 1);
}

/* ---- documents ---- */

static WrField *random_field(double low, double high, TestRandom *random)
{
    WrField *field = wr_field_new(WIDTH, HEIGHT, WR_WRAP_PERIODIC, WR_WRAP_PERIODIC, 0, NULL);
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++)
            wr_field_set(field, i, j, (float)(low + (high - low) * test_random(random)));
    return field;
}

/* Half of it is 0, half of the rest 1. */
static WrField *random_cover(TestRandom *random)
{
    WrField *field = random_field(-1, 1, random);
    for (int j = 0; j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) {
            float c = wr_field_get(field, i, j);
            wr_field_set(field, i, j, c < 0 ? 0 : c > 0.5f ? 1 : 2 * c);
        }
    return field;
}

typedef enum Kind {
    PLAIN, /* heights whose sums stay in range, and factors of 0 or more */
    /* also negative heights, and no factors, which are portable only where black is height 0 */
    NEGATIVE,
    WHOLE, /* coverage is 0 or 1, and no additions */
    ANY,   /* every blend mode with any values */
    KINDS
} Kind;

static WrBlend random_blend(Kind kind, TestRandom *random)
{
    static const WrBlend blends[] = { WR_BLEND_MULTIPLY, WR_BLEND_ADD,     WR_BLEND_MAX,
                                      WR_BLEND_MIN,      WR_BLEND_MIX,     WR_BLEND_REPLACE,
                                      WR_BLEND_ADD,      WR_BLEND_SUBTRACT };
    static const WrBlend whole[] = { WR_BLEND_MULTIPLY, WR_BLEND_MAX, WR_BLEND_MIN, WR_BLEND_MIX,
                                     WR_BLEND_REPLACE };
    if (kind == ANY) return (WrBlend)(test_random(random) * WR_BLEND_COUNT);
    if (kind == WHOLE) return whole[(int)(test_random(random) * 5)];
    return blends[(kind == NEGATIVE) + (int)(test_random(random) * 7)];
}

static void make_whole(WrField *field)
{
    for (int j = 0; field && j < HEIGHT; j++)
        for (int i = 0; i < WIDTH; i++) wr_field_set(field, i, j, wr_field_get(field, i, j) > 0.5f);
}

static WrDocument *random_document(uint64_t seed, Kind kind)
{
    const bool negative = kind == NEGATIVE || kind == ANY;
    TestRandom random = { seed };
    double low = negative ? -0.3 : 0.0;
    WrDocument *document = wr_document_new();
    wr_document_start_over(document, random_field(low, 0.6, &random));
    if (negative) wr_field_set(document->layers[0].heights, 5, 5, -0.5f);
    int count = 1 + (int)(5 * test_random(&random));
    for (int i = 1; i < count; i++) {
        WrLayer layer = wr_layer_make("layer", document->layers[0].heights);
        layer.blend = random_blend(kind, &random);
        layer.radius = 0.1f;
        bool sum = kind != ANY && (layer.blend == WR_BLEND_ADD || layer.blend == WR_BLEND_SUBTRACT);
        wr_field_free(layer.heights);
        wr_field_free(layer.cover);
        layer.heights = random_field(sum ? 0 : low, sum ? 0.04 : 0.6, &random);
        layer.cover = random_cover(&random);
        if (test_random(&random) < 0.3) layer.mask = random_field(0, 1, &random);
        if (test_random(&random) < 0.5) layer.opacity = (float)test_random(&random);
        if (kind == WHOLE) {
            make_whole(layer.cover);
            make_whole(layer.mask);
            layer.opacity = 1;
        }
        layer.visible = test_random(&random) > 0.2;
        wr_document_insert(document, i, layer);
    }
    WrLayer *base = &document->layers[0];
    if (test_random(&random) < 0.3) base->opacity = (float)test_random(&random);
    if (test_random(&random) < 0.3) base->mask = random_field(0, 1, &random);
    if (test_random(&random) < 0.3) base->blend = WR_BLEND_REPLACE;
    base->visible = test_random(&random) > 0.2;
    if (test_random(&random) < 0.2) document->solo = (int)(count * test_random(&random));
    return document;
}

/* Groups of its layers, sometimes of the lowest one too. */
static void add_groups(WrDocument *document, Kind kind, TestRandom *random)
{
    static const WrBlend whole[] = { WR_BLEND_MULTIPLY, WR_BLEND_MAX, WR_BLEND_MIN,
                                     WR_BLEND_REPLACE };
    for (int k = 0; k < 2; k++) {
        bool chosen[WR_LAYERS_MAX] = { test_random(random) < 0.15 };
        for (int i = 1; i < document->layer_count; i++) chosen[i] = test_random(random) < 0.5;
        chosen[document->layer_count - 1] = true;
        const int made = wr_document_group(document, chosen, "group <1>");
        WrLayer *group = &document->layers[made];
        group->blend = random_blend(kind, random);
        if (kind == WHOLE) group->blend = whole[(int)(test_random(random) * 4)];
        if (kind != WHOLE) group->opacity = (float)test_random(random);
        if (kind == ANY) group->mask = random_field(0, 1, random);
        group->visible = test_random(random) > 0.2;
        group->collapsed = test_random(random) < 0.5;
    }
}

static bool shows_any(const WrDocument *document)
{
    for (int i = 0; i < document->layer_count; i++)
        if (wr_document_shows(document, i)) return true;
    return false;
}

/* ---- tests ---- */

/* Grey and alpha of each layer are rounded to 16 bits. */
static void check_picture(zip_t *archive, int layers, Stranger by)
{
    static double grey[COUNT], alpha[COUNT];
    size_t length;
    memset(grey, 0, sizeof grey);
    memset(alpha, 0, sizeof alpha);
    char *xml = entry(archive, "stack.xml", &length);
    const char *top = strchr(strstr(xml, "<stack>") + 1, '<');
    compose(archive, top, by, grey, alpha);
    check_lowest(top);
    WrImage *merged = picture(archive, "mergedimage.png");
    for (int i = 0; i < COUNT; i++) {
        assert_near(alpha[i], 1, 1e-12);
        assert_near(pow(grey[i], 1 / by.gamma), merged->data[4 * i], (1.5 * layers + 1) / 65535);
    }
    wr_image_free(merged);
    free(xml);
}

static void others_see_the_picture_that_we_have(void **state)
{
    (void)state;
    int seen = 0, composites[KINDS] = { 0 }, portable = 0;
    for (uint64_t seed = 1; seed <= 160; seed++) {
        const bool groups = seed > 80;
        WrError err = { "" };
        const Kind kind = (Kind)(seed % KINDS);
        WrDocument *document = random_document(seed, kind);
        if (groups) add_groups(document, kind, &(TestRandom){ seed });
        WrHash before = wr_document_hash(document, "");
        if (!wr_ora_save(document, "", "a.ora", NULL, &err)) fail_msg("%s", err.text);
        WrLoaded loaded = { 0 };
        int64_t replaced;
        if (!wr_ora_load("a.ora", &loaded, &replaced, NULL, &err)) fail_msg("%s", err.text);
        assert_true(wr_hash_equal(before, wr_document_hash(loaded.document, "")));
        zip_t *archive = zip_open("a.ora", ZIP_RDONLY, NULL);
        size_t length;
        char *xml = entry(archive, "stack.xml", &length);
        const bool composite = strstr(xml, "wrinkle:composite") != NULL;
        composites[kind] += !groups && composite;
        portable += groups && !composite;
        free(xml);
        if (shows_any(document)) {
            const int layers = document->layer_count;
            check_picture(archive, layers, (Stranger){ 1, false });
            check_picture(archive, layers, (Stranger){ 2.2, false });
            /* A viewer that hides the composite and blends codes unchanged computes the picture from the layers. */
            if (kind != ANY && (!groups || !composite))
                check_picture(archive, layers, (Stranger){ 1, true });
            seen++;
        }
        zip_discard(archive);
        wr_document_free(loaded.document);
        wr_free(loaded.scene_text);
        wr_document_free(document);
    }
    assert_true(seen > 110 && portable > 4);
    assert_true(composites[PLAIN] > 5 && composites[NEGATIVE] > 5 && composites[ANY] > 5);
    assert_int_equal(composites[WHOLE], 0);
}

static uint32_t number_at(const uint8_t *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* Krita requests the profile of each 16-bit picture without an iCCP chunk; gAMA and sRGB do not help. */
static void check_profile(zip_t *archive, const char *name)
{
    size_t length;
    uint8_t want[WR_SRGB_PROFILE_SIZE], is[2 * WR_SRGB_PROFILE_SIZE];
    uint8_t *png = (uint8_t *)entry(archive, name, &length), *at = png + 8;
    while (memcmp(at + 4, "iCCP", 4) != 0) {
        if (memcmp(at + 4, "IDAT", 4) == 0) fail_msg("%s: no profile before the picture", name);
        at += 12 + number_at(at);
    }
    size_t title = strlen((char *)at + 8);
    uLongf size = sizeof is;
    assert_int_equal(uncompress(is, &size, at + 8 + title + 2, number_at(at) - title - 2), Z_OK);
    wr_srgb_profile(want);
    assert_int_equal(size, sizeof want);
    assert_memory_equal(is, want, sizeof want);
    free(png);
}

static void every_picture_of_16_bits_names_its_profile(void **state)
{
    (void)state;
    WrError err = { "" };
    WrDocument *document = random_document(3, false);
    if (!wr_ora_save(document, "", "a.ora", NULL, &err)) fail_msg("%s", err.text);
    zip_t *archive = zip_open("a.ora", ZIP_RDONLY, NULL);
    check_profile(archive, "mergedimage.png");
    for (int i = 0; i < document->layer_count; i++) {
        char name[32];
        snprintf(name, sizeof name, "data/layer%d.png", i + 1);
        check_profile(archive, name);
    }
    zip_discard(archive);
    wr_document_free(document);
}

/* Fields read by libpng and colour engines; all numbers are big-endian. */
static void the_profile_is_sound(void **state)
{
    (void)state;
    uint8_t p[WR_SRGB_PROFILE_SIZE];
    wr_srgb_profile(p);
    assert_int_equal(number_at(p), sizeof p);
    assert_memory_equal(p + 12, "mntrRGB XYZ ", 12);
    assert_memory_equal(p + 36, "acsp", 4);
    assert_int_equal(number_at(p + 68), 0xf6d6); /* D50, as required by the format */
    assert_int_equal(number_at(p + 72), 0x10000);
    assert_int_equal(number_at(p + 76), 0xd32d);
    uint32_t tags = number_at(p + 128), end = 132 + 12 * tags;
    double white[3] = { 0 };
    for (uint32_t i = 0; i < tags; i++) {
        const uint8_t *tag = p + 132 + 12 * i;
        uint32_t from = number_at(tag + 4), size = number_at(tag + 8);
        assert_true(from % 4 == 0 && from <= end && from + size <= sizeof p);
        if (from == end) end += (size + 3) & ~3u; /* consecutive, without gaps */
        for (int c = 0; c < 3 && memcmp(tag + 1, "XYZ", 3) == 0; c++)
            white[c] += (int32_t)number_at(p + from + 8 + 4 * (uint32_t)c) / 65536.0;
    }
    assert_int_equal(end, sizeof p);
    assert_near(white[0], 0.9642, 1e-4); /* the primaries add up to white */
    assert_near(white[1], 1.0, 1e-4);
    assert_near(white[2], 0.8249, 3e-4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(others_see_the_picture_that_we_have),
        cmocka_unit_test(every_picture_of_16_bits_names_its_profile),
        cmocka_unit_test(the_profile_is_sound),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
