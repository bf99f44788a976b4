/* PNG by libpng against PNG by OpenImageIO: every kind of pixel, interlaced or not, with metadata; rows in any order;
   and files of the program read by both. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "base/enum_rows.h"
#include "base/memory.h"
#include "base/pool.h"
#include "image/oiio.h"
#include "image/png.h"
#include "system/fd.h"

#include <fcntl.h>
#include <math.h>
#include <png.h>

typedef struct Kind {
    const char *what;
    int depth, colour;
    bool see_through, interlaced; /* a tRNS chunk */
} Kind;

#define WIDTH 37
#define HEIGHT 29

static const Kind kinds[] = {
    { "1 bit", 1, PNG_COLOR_TYPE_GRAY, false, false },
    { "2 bits, see-through", 2, PNG_COLOR_TYPE_GRAY, true, true },
    { "4 bits", 4, PNG_COLOR_TYPE_GRAY, false, true },
    { "grey", 8, PNG_COLOR_TYPE_GRAY, false, false },
    { "grey of 16 bits, see-through", 16, PNG_COLOR_TYPE_GRAY, true, false },
    { "grey and alpha", 8, PNG_COLOR_TYPE_GRAY_ALPHA, false, true },
    { "grey and alpha of 16 bits", 16, PNG_COLOR_TYPE_GRAY_ALPHA, false, false },
    { "colours", 8, PNG_COLOR_TYPE_RGB, false, true },
    { "colours, one see-through", 8, PNG_COLOR_TYPE_RGB, true, false },
    { "colours of 16 bits", 16, PNG_COLOR_TYPE_RGB, false, true },
    { "colours and alpha", 8, PNG_COLOR_TYPE_RGB_ALPHA, false, false },
    { "colours and alpha of 16 bits", 16, PNG_COLOR_TYPE_RGB_ALPHA, false, true },
    { "palette of 1 bit", 1, PNG_COLOR_TYPE_PALETTE, false, false },
    { "palette of 4 bits, see-through", 4, PNG_COLOR_TYPE_PALETTE, true, false },
    { "palette, see-through", 8, PNG_COLOR_TYPE_PALETTE, true, true },
};

/* Colours of the palette, and a transparency chunk. */
static void print_colours(png_structp png, png_infop info, const Kind *kind, TestRandom *random)
{
    png_color colours[256];
    png_byte alphas[200];
    png_color_16 none = { .red = 3, .green = 3, .blue = 3, .gray = 1 };
    const int count = 1 << (kind->depth > 8 ? 8 : kind->depth);
    for (int i = 0; i < count; i++)
        colours[i] =
            (png_color){ (png_byte)test_random_u64(random), (png_byte)test_random_u64(random),
                         (png_byte)test_random_u64(random) };
    for (int i = 0; i < 200; i++) alphas[i] = (png_byte)test_random_u64(random);
    if (kind->colour == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(png, info, colours, count);
    if (kind->see_through && kind->colour == PNG_COLOR_TYPE_PALETTE)
        png_set_tRNS(png, info, alphas, count < 200 ? count - 1 : 200, NULL);
    else if (kind->see_through) png_set_tRNS(png, info, NULL, 0, &none);
}

static void write_kind(const char *path, const Kind *kind, TestRandom *random)
{
    static png_byte rows[HEIGHT][8 * WIDTH];
    static uint8_t exif[] = { 'M', 'M', 0, 42, 0, 0, 0, 8, 0, 1, 1, 0x12, 0,
                              3,   0,   0, 0,  1, 0, 6, 0, 0, 0, 0, 0,    0 };
    png_bytep all[HEIGHT];
    char key[] = "Description", text[] = "a hill\nwrinkle:kind=height\nwrinkle:range=-1,2\n";
    png_text words = { .compression = PNG_TEXT_COMPRESSION_zTXt,
                       .key = key,
                       .text = text,
                       .text_length = strlen(text) };
    FILE *file = fopen(path, "wb");
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, NULL, NULL, NULL);
    png_infop info = png_create_info_struct(png);
    png_init_io(png, file);
    png_set_IHDR(png, info, WIDTH, HEIGHT, kind->depth, kind->colour,
                 kind->interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    print_colours(png, info, kind, random);
    png_set_text(png, info, &words, 1);
    if (kind->interlaced) png_set_eXIf_1(png, info, sizeof exif, exif);
    png_write_info(png, info);
    for (int y = 0; y < HEIGHT; y++) {
        for (size_t i = 0; i < sizeof rows[y]; i++) /* some are transparent */
            rows[y][i] = (png_byte)(test_random_u64(random) % (y % 3 ? 256 : 4));
        all[y] = rows[y];
    }
    png_write_image(png, all);
    png_write_end(png, NULL);
    png_destroy_write_struct(&png, &info);
    fclose(file);
}

static WrCodecReader *open_by(const WrCodec *codec, int fd)
{
    char reason[WR_CODEC_REASON] = "";
    WrCodecReader *reader = codec->open(fd, "png", 1, false, reason);
    if (!reader) fail_msg("%s", reason);
    return reader;
}

static void assert_same_text(const WrCodec *a, const WrCodecReader *by_a, const WrCodec *b,
                             const WrCodecReader *by_b, const char *name)
{
    const char *left = a->attribute(by_a, 0, name), *right = b->attribute(by_b, 0, name);
    if (strcmp(left ? left : "none", right ? right : "none") != 0)
        fail_msg("%s: %s and %s", name, left ? left : "none", right ? right : "none");
}

/* Rows from any position, in bands, with all channels. */
static void assert_same_file(const char *path, const char *what, TestRandom *random)
{
    static float ours[HEIGHT * WIDTH * 4], theirs[HEIGHT * WIDTH * 4];
    WrError err = { "" };
    char reason[WR_CODEC_REASON] = "";
    const WrCodec *png = wr_codec("png", &err), *oiio = wr_oiio(&err);
    const int fd = open(path, O_RDONLY);
    WrCodecReader *a = open_by(png, fd), *b = open_by(oiio, fd);
    const WrCodecPart *x = png->part(a, 0), *y = oiio->part(b, 0);
    if (x->part.width != y->part.width || x->part.height != y->part.height ||
        x->part.channels != y->part.channels || x->part.type != y->part.type)
        fail_msg("%s: %dx%d, %d channels of type %d, but by OpenImageIO %dx%d, %d of %d", what,
                 x->part.width, x->part.height, x->part.channels, x->part.type, y->part.width,
                 y->part.height, y->part.channels, y->part.type);
    for (int c = 0; c < x->part.channels; c++)
        assert_string_equal(x->part.channel_names[c], y->part.channel_names[c]);
    assert_same_text(png, a, oiio, b, "wrinkle:kind");
    assert_same_text(png, a, oiio, b, "wrinkle:range");
    assert_same_text(png, a, oiio, b, "wrinkle:none");
    assert_same_text(png, a, oiio, b, "wrinkle:orientation");
    for (int i = 0; i < 12; i++) {
        const int first = (int)(test_random_u64(random) % (unsigned)x->part.height);
        const int rows = 1 + (int)(test_random_u64(random) % (unsigned)(x->part.height - first));
        const int channels = 1 + (int)(test_random_u64(random) % (unsigned)x->part.channels);
        const size_t count = (size_t)rows * (size_t)x->part.width * (size_t)channels;
        if (!png->read(a, 0, first, rows, channels, ours, reason)) fail_msg("%s: %s", what, reason);
        if (!oiio->read(b, 0, first, rows, channels, theirs, reason))
            fail_msg("%s: %s", what, reason);
        for (size_t k = 0; k < count; k++)
            if (ours[k] != theirs[k])
                fail_msg("%s: rows from %d, %d channels: value %zu is %.9g, by OpenImageIO %.9g",
                         what, first, channels, k, (double)ours[k], (double)theirs[k]);
    }
    png->close(a);
    oiio->close(b);
    close(fd);
}

static void every_kind_is_read_as_by_openimageio(void **state)
{
    (void)state;
    TestRandom random = { 41 };
    for (int i = 0; i < WR_LENGTH(kinds); i++) {
        write_kind("kind.png", &kinds[i], &random);
        assert_same_file("kind.png", kinds[i].what, &random);
    }
}

typedef struct Codes {
    int width, channels, bytes;
} Codes;

static bool code_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const Codes *codes = ctx;
    uint8_t *to = out;
    (void)err;
    for (int i = 0; i < rows * codes->width * codes->channels * codes->bytes; i++)
        to[i] = (uint8_t)((i * 31 + y * 7) % 251);
    return true;
}

static void what_is_written_is_read_by_both(void **state)
{
    (void)state;
    static const WrImageAttribute texts[] = { { "wrinkle:kind", "height" },
                                              { "wrinkle:range", "-1.25,3" } };
    TestRandom random = { 43 };
    for (int i = 0; i < 8; i++) {
        WrError err = { "" };
        Codes codes = { WIDTH, i % 4 + 1, i / 4 + 1 };
        const WrImageOut part = { .width = WIDTH,
                                  .height = HEIGHT,
                                  .channels = codes.channels,
                                  .type = i / 4 ? WR_PIXEL_U16 : WR_PIXEL_U8,
                                  .attributes = texts,
                                  .attribute_count = 2,
                                  .data = i % 2,
                                  .rows = code_rows,
                                  .ctx = &codes };
        if (!wr_image_write("ours.png", &part, 1, &err)) fail_msg("%s", err.text);
        assert_same_file("ours.png", "ours", &random);
    }
}

/* Rows without a repetition, then rows of which each half repeats the other: both strategies of compression, in more
   segments than one batch holds. */
static bool mixed_rows(void *ctx, int y, int rows, void *out, WrError *err)
{
    const WrImageOut *part = ctx;
    const size_t row = (size_t)part->width * (size_t)part->channels;
    (void)err;
    for (int j = y; j < y + rows; j++) {
        TestRandom random = { (uint64_t)j };
        uint16_t *to = (uint16_t *)out + (size_t)(j - y) * row;
        for (size_t i = 0; i < row; i++)
            to[i] = j > part->height / 2 && i > row / 2 ? to[i - row / 2]
                                                        : (uint16_t)test_random_u64(&random);
    }
    return true;
}

static void assert_large_by_openimageio(WrImageOut *part, const char *bytes, size_t length)
{
    char reason[WR_CODEC_REASON] = "";
    WrError err = { "" };
    const int fd = open("large.png", O_RDWR | O_CREAT, 0600);
    assert_int_equal(write(fd, bytes, length), length);
    const WrCodec *oiio = wr_oiio(&err);
    WrCodecReader *reader = open_by(oiio, fd);
    const size_t count = (size_t)part->width * (size_t)part->height * (size_t)part->channels;
    float *have = malloc(count * sizeof *have);
    uint16_t *want = malloc(count * sizeof *want);
    if (!oiio->read(reader, 0, 0, part->height, part->channels, have, reason))
        fail_msg("%s", reason);
    mixed_rows(part, 0, part->height, want, &err);
    for (size_t i = 0; i < count; i++)
        if (have[i] != (float)want[i] / 65535.0f) fail_msg("value %zu is not the one written", i);
    oiio->close(reader);
    close(fd);
    free(have);
    free(want);
}

static void large_files_do_not_depend_on_threads(void **state)
{
    (void)state;
    WrPool *pool = wr_pool_new(3);
    WrImageOut part = { .width = 1371,
                        .height = 809,
                        .channels = 3,
                        .type = WR_PIXEL_U16,
                        .rows = mixed_rows,
                        .ctx = &part };
    char *bytes[2];
    size_t length[2];
    for (int i = 0; i < 2; i++) {
        WrError err = { "" };
        part.pool = i ? pool : NULL;
        if (!wr_image_write_bytes("large.png", &part, &bytes[i], &length[i], &err))
            fail_msg("%s", err.text);
    }
    assert_int_equal(length[0], length[1]);
    assert_memory_equal(bytes[0], bytes[1], length[0]);
    /* random halves are stored as they are, repeated ones once: three quarters, and little more */
    assert_in_range(length[0], 0.75 * 6 * 1371 * 809, 0.78 * 6 * 1371 * 809);
    assert_large_by_openimageio(&part, bytes[0], length[0]);
    for (int i = 0; i < 2; i++) wr_free(bytes[i]);
    wr_pool_free(pool);
}

static bool has_chunk(const char *path, const char *name)
{
    unsigned char bytes[4096];
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    const size_t n = fread(bytes, 1, sizeof bytes, file);
    fclose(file);
    for (size_t i = 8; i + 8 <= n;) {
        if (memcmp(bytes + i + 4, name, 4) == 0) return true;
        i += 12 + ((size_t)bytes[i] << 24 | (size_t)bytes[i + 1] << 16 | (size_t)bytes[i + 2] << 8 |
                   bytes[i + 3]);
    }
    return false;
}

/* With a gAMA chunk ImageMagick, browsers and others would change the numbers of a normal map. */
static void of_numbers_no_colour_space_is_said(void **state)
{
    (void)state;
    static const char *const spaces[] = { "gAMA", "sRGB", "cHRM", "iCCP", "cICP" };
    for (int data = 0; data < 2; data++) {
        WrError err = { "" };
        Codes codes = { WIDTH, 3, 2 };
        const WrImageOut part = { .width = WIDTH,
                                  .height = HEIGHT,
                                  .channels = 3,
                                  .type = WR_PIXEL_U16,
                                  .data = data,
                                  .rows = code_rows,
                                  .ctx = &codes };
        if (!wr_image_write("said.png", &part, 1, &err)) fail_msg("%s", err.text);
        assert_true(has_chunk("said.png", "IDAT"));
        for (int i = 0; i < 5; i++)
            assert_int_equal(has_chunk("said.png", spaces[i]), !data && i < 3);
    }
}

/* Damage at any position is reported or harmless; nothing is printed to standard error. */
static void damage_is_told_in_one_line(void **state)
{
    (void)state;
    static float out[HEIGHT * WIDTH * 4];
    TestRandom random = { 47 };
    int told = 0;
    for (int round = 0; round < 300; round++) {
        const Kind *kind = &kinds[test_random_u64(&random) % WR_LENGTH(kinds)];
        char reason[WR_CODEC_REASON] = "";
        write_kind("damaged.png", kind, &random);
        const int fd = open("damaged.png", O_RDWR);
        const off_t size = lseek(fd, 0, SEEK_END);
        const off_t at = 8 + (off_t)(test_random_u64(&random) % (uint64_t)(size - 8));
        const uint8_t byte = (uint8_t)test_random_u64(&random);
        if (round % 3 == 0) assert_int_equal(ftruncate(fd, at), 0);
        else assert_int_equal(pwrite(fd, &byte, 1, at), 1);
        WrCodecReader *reader = wr_png_codec.open(fd, "png", 1, false, reason);
        if (reader) {
            const WrImagePart *part = &wr_png_codec.part(reader, 0)->part;
            if (part->width <= WIDTH && part->height <= HEIGHT)
                wr_png_codec.read(reader, 0, 0, part->height, part->channels, out, reason);
            wr_png_codec.close(reader);
        }
        told += reason[0] != '\0';
        assert_null(strchr(reason, '\n'));
        close(fd);
    }
    assert_true(told > 100);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_kind_is_read_as_by_openimageio),
        cmocka_unit_test(what_is_written_is_read_by_both),
        cmocka_unit_test(large_files_do_not_depend_on_threads),
        cmocka_unit_test(of_numbers_no_colour_space_is_said),
        cmocka_unit_test(damage_is_told_in_one_line),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
