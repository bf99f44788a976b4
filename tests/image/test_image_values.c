/* Pixel values in files of other programs: inverted greys, integers with scaling, missing values, display windows,
   rotated and run-length pictures. Files of tests/image/cases are from other programs. */
#include "test.h"
#include "test_folder.h"

#include "base/error.h"
#include "image/image.h"

#include <math.h>

#define WIDTH 13
#define HEIGHT 7

typedef struct Tiff {
    int bits, channels;
    bool white_is_0, big;
    bool no_data;         /* GDAL's tag: 9 marks missing values */
    const char *metadata; /* GDAL's tag */
} Tiff;

static unsigned long last_of(int bits)
{
    return bits == 32 ? 0xffffffffUL : (1UL << bits) - 1;
}

/* The code of a pixel by its meaning: 0 is black; channel 1 is alpha. */
static unsigned long code_of(const Tiff *tiff, int x, int y, int channel)
{
    const double share = channel ? (x + y) % 5 / 4.0 : (x * 37 + y * 53 + 11) % 101 / 100.0;
    return (unsigned long)floor(share * (double)last_of(tiff->bits) + 0.5);
}

static void put(FILE *file, bool big, unsigned long value, int bytes)
{
    for (int k = 0; k < bytes; k++)
        putc((int)(value >> 8 * (big ? bytes - 1 - k : k) & 0xff), file);
}

/* Whole-byte codes in the file's byte order, others packed from the highest bit, each row padded. */
static void put_pixels(FILE *file, const Tiff *tiff)
{
    for (int y = 0; y < HEIGHT; y++) {
        unsigned long held = 0;
        int bits = 0;
        for (int k = 0; k < WIDTH * tiff->channels; k++) {
            const int channel = k % tiff->channels;
            unsigned long code = code_of(tiff, k / tiff->channels, y, channel);
            if (tiff->white_is_0 && channel == 0) code = last_of(tiff->bits) - code;
            if (tiff->bits % 8 == 0) {
                put(file, tiff->big, code, tiff->bits / 8);
                continue;
            }
            held = held << tiff->bits | code;
            for (bits += tiff->bits; bits >= 8; bits -= 8)
                putc((int)(held >> (bits - 8) & 0xff), file);
            held &= (1UL << bits) - 1;
        }
        if (bits > 0) putc((int)(held << (8 - bits) & 0xff), file);
    }
}

static void put_tag(FILE *file, bool big, int tag, int type, unsigned long count,
                    unsigned long value)
{
    put(file, big, (unsigned long)tag, 2);
    put(file, big, (unsigned long)type, 2);
    put(file, big, count, 4);
    if (type == 3) {
        put(file, big, value, 2);
        put(file, big, count > 1 ? value : 0, 2);
    } else {
        put(file, big, value, 4);
    }
}

/* TIFF 6.0: header, pixels, one directory. */
static void write_tiff(const char *path, const Tiff *tiff)
{
    const int row = (WIDTH * tiff->channels * tiff->bits + 7) / 8, size = row * HEIGHT;
    const bool big = tiff->big;
    const unsigned long n = (unsigned long)tiff->channels;
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(big ? "MM" : "II", file);
    put(file, big, 42, 2);
    const char *more = tiff->metadata ? tiff->metadata : "";
    const unsigned long end = 8UL + (unsigned long)(size + size % 2), length = strlen(more);
    put(file, big, end + length + length % 2, 4);
    put_pixels(file, tiff);
    if (size % 2) putc(0, file);
    fprintf(file, "%s%s", more, length % 2 ? " " : "");
    put(file, big, 10UL + (n > 1) + tiff->no_data + (length > 0), 2);
    put_tag(file, big, 256, 3, 1, WIDTH);
    put_tag(file, big, 257, 3, 1, HEIGHT);
    put_tag(file, big, 258, 3, n, (unsigned long)tiff->bits);
    put_tag(file, big, 259, 3, 1, 1);
    put_tag(file, big, 262, 3, 1, tiff->white_is_0 ? 0 : 1);
    put_tag(file, big, 273, 4, 1, 8);
    put_tag(file, big, 277, 3, 1, n);
    put_tag(file, big, 278, 3, 1, HEIGHT);
    put_tag(file, big, 279, 4, 1, (unsigned long)size);
    put_tag(file, big, 284, 3, 1, 1);
    if (n > 1) put_tag(file, big, 338, 3, 1, 2); /* unassociated alpha */
    if (length > 0) put_tag(file, big, 42112, 2, length, end);
    if (tiff->no_data) put_tag(file, big, 42113, 2, 2, '9');
    put(file, big, 0, 4);
    fclose(file);
}

static void check_tiff(const Tiff *tiff)
{
    WrError err;
    write_tiff("a.tif", tiff);
    WrImage *image = wr_image_read("a.tif", &err);
    if (!image) fail_msg("%d bits: %s", tiff->bits, err.text);
    assert_int_equal(image->channels, tiff->channels);
    /* 10, 12 and 14 bits are widened to codes of 16 */
    const double allowed = tiff->bits > 8 && tiff->bits < 16 ? 1.0 / 65535 : 1e-7;
    for (int k = 0; k < WIDTH * HEIGHT * tiff->channels; k++) {
        const int pixel = k / tiff->channels;
        const double code = (double)code_of(tiff, pixel % WIDTH, pixel / WIDTH, k % tiff->channels);
        const double off = fabs((double)image->data[k] - code / (double)last_of(tiff->bits));
        if (!(off <= allowed))
            fail_msg("%d bits, %d channels, white is 0: %d, big: %d, value %d: off by %g",
                     tiff->bits, tiff->channels, tiff->white_is_0, tiff->big, k, off);
    }
    wr_image_free(image);
}

static void smallest_is_white_at_every_depth(void **state)
{
    (void)state;
    static const int depths[] = { 1, 2, 4, 8, 10, 12, 14, 16, 32 };
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d++)
        for (int k = 0; k < 8; k++)
            check_tiff(&(Tiff){ depths[d], 1 + k % 2, (k & 2) != 0, (k & 4) != 0, false, NULL });
}

static void a_depth_that_is_not_read_is_named(void **state)
{
    (void)state;
    WrError err;
    write_tiff("24.tif", &(Tiff){ 24, 1, false, false, false, NULL });
    assert_null(wr_image_read("24.tif", &err));
    assert_non_null(strstr(err.text, "24 bits a channel"));
}

/* Measured values of less than 16 bits are the file's numbers, not those that the library widens. */
static void narrow_elevations_are_numbers(void **state)
{
    (void)state;
    static const int depths[] = { 4, 8, 10, 12, 14, 16 };
    const WrImageRequest wish = { .elevation = true };
    for (size_t d = 0; d < sizeof depths / sizeof *depths; d++) {
        WrError err;
        const Tiff tiff = { .bits = depths[d], .channels = 1, .no_data = true };
        write_tiff("narrow.tif", &tiff);
        WrImage *image = wr_image_read_request("narrow.tif", &wish, &err);
        if (!image) fail_msg("%d bits: %s", tiff.bits, err.text);
        for (int k = 0; k < WIDTH * HEIGHT; k++) {
            const double number = (double)code_of(&tiff, k % WIDTH, k / WIDTH, 0);
            if (number < 9 || number > 9) /* else missing, and filled */
                assert_float_equal((double)image->data[k], number, 0);
        }
        wr_image_free(image);
    }
}

/* GDAL: value = scale x number + offset. Codes that are not measured have none. */
static void elevations_have_the_scale_of_their_header(void **state)
{
    (void)state;
    const WrImageRequest wish = { .elevation = true };
    const Tiff tiff = { .bits = 16,
                        .channels = 1,
                        .no_data = true,
                        .metadata = "<GDALMetadata><Item name=\"OFFSET\" sample=\"0\" "
                                    "role=\"offset\">-50</Item><Item name=\"SCALE\" sample=\"0\" "
                                    "role=\"scale\">0.25</Item></GDALMetadata>" };
    WrError err;
    write_tiff("scaled.tif", &tiff);
    WrImage *image = wr_image_read_request("scaled.tif", &wish, &err);
    if (!image) fail_msg("%s", err.text);
    for (int k = 0; k < WIDTH * HEIGHT; k++)
        assert_float_equal((double)image->data[k],
                           0.25 * (double)code_of(&tiff, k % WIDTH, k / WIDTH, 0) - 50, 0);
    wr_image_free(image);
    image = wr_image_read("scaled.tif", &err);
    if (!image) fail_msg("%s", err.text);
    assert_float_equal((double)image->data[0], (double)code_of(&tiff, 0, 0, 0) / 65535, 1e-7);
    wr_image_free(image);
}

static WrImage *read_case(const char *name, const WrImageRequest *wish)
{
    char path[512];
    WrError err;
    snprintf(path, sizeof path, "%s/tests/image/cases/%s", WR_SOURCE_DIR, name);
    WrImage *image = wr_image_read_request(path, wish, &err);
    if (!image) fail_msg("%s", err.text);
    return image;
}

/* The first 700 of the 1118 bytes of a progressive JPEG file. */
static void a_cut_progressive_jpeg_is_refused(void **state)
{
    (void)state;
    WrError err = { "" };
    assert_null(wr_image_read(WR_SOURCE_DIR "/tests/image/cases/cut_progressive.jpg", &err));
    assert_non_null(strstr(err.text, "truncated or damaged"));
}

static void check_range(const WrImage *image, double low, double high)
{
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < image->width * image->height * image->channels; k++) {
        least = fmin(least, (double)image->data[k]);
        most = fmax(most, (double)image->data[k]);
    }
    assert_true(least == low && most == high);
}

/* By the files' bytes: signed metres 101 to 899 with 16 voids; 16 values of -12345, as in GDAL's tag. */
static void missing_elevations_are_filled(void **state)
{
    (void)state;
    const WrImageRequest plain = { 0 }, kept = { .keep_lost = true };
    WrImage *image = read_case("dem_srtm.tif", &plain);
    check_range(image, 101, 899);
    assert_true(image->filled == 16 && image->replaced == 0);
    assert_true(image->data[0] == 306 && image->data[1] == 801 && image->data[2] == 218);
    wr_image_free(image);
    image = read_case("t_dem_nodata.tif", &plain);
    assert_int_equal(image->filled, 16);
    for (int k = 0; k < image->width * image->height; k++)
        assert_true(image->data[k] > 99 && image->data[k] < 151);
    wr_image_free(image);
    image = read_case("t_dem_nodata.tif", &kept);
    int lost = 0;
    for (int k = 0; k < image->width * image->height; k++) lost += isnan(image->data[k]);
    assert_true(lost == 16 && image->filled == 0);
    wr_image_free(image);
}

/* Three voids in ground of 100 to 381: -32768 in 32 bits without a tag; the tag "nan"; the smallest float, with six
   digits in the tag. */
static void no_data_is_found_however_it_is_written(void **state)
{
    (void)state;
    static const char *const names[] = { "void_int32.tif", "no_data_nan.tif", "no_data_short.tif" };
    const WrImageRequest plain = { 0 };
    for (size_t k = 0; k < sizeof names / sizeof *names; k++) {
        WrImage *image = read_case(names[k], &plain);
        check_range(image, 100, 381);
        assert_int_equal(image->filled, 3);
        wr_image_free(image);
    }
}

/* IDs 0 to 97; and a FITS header with BZERO 32768: the stored -25408, -27276 are 7360, 5492. */
static void integers_are_the_numbers_of_their_header(void **state)
{
    (void)state;
    const WrImageRequest plain = { 0 };
    WrImage *image = read_case("e_uint.exr", &plain);
    check_range(image, 0, 97);
    wr_image_free(image);
    image = read_case("k16im.fits", &plain);
    check_range(image, 4458, 25594);
    const float *bottom = image->data + 23 * 32; /* FITS starts at the bottom */
    assert_true(bottom[0] == 7360 && bottom[1] == 5492);
    wr_image_free(image);
}

/* 15 x 10 pixels at (10, 5) of a picture of 30 x 20; 30 x 20 about one of 20 x 12. */
static void an_exr_is_its_display_window(void **state)
{
    (void)state;
    const WrImageRequest plain = { 0 };
    WrImage *image = read_case("e_crop.exr", &plain);
    assert_true(image->width == 30 && image->height == 20 && image->note[0]);
    for (int y = 0; y < 20; y++)
        for (int x = 0; x < 30; x++) {
            const bool inside = x >= 10 && x < 25 && y >= 5 && y < 15;
            if (!inside) assert_true(image->data[(y * 30 + x) * image->channels] == 0);
        }
    assert_true(image->data[(5 * 30 + 10) * image->channels] > 0);
    wr_image_free(image);
    image = read_case("e_over.exr", &plain);
    assert_true(image->width == 20 && image->height == 12 && image->note[0]);
    wr_image_free(image);
}

/* A gradient of 20 x 10 with EXIF orientation 6; and a first pixel by ImageMagick: 202, 159, 90. */
static void webp_is_turned_and_run_length_bmp_read(void **state)
{
    (void)state;
    const WrImageRequest plain = { 0 };
    WrImage *image = read_case("exif_turned.webp", &plain);
    assert_true(image->width == 10 && image->height == 20);
    wr_image_free(image);
    image = read_case("rle8.bmp", &plain);
    assert_true(image->width == 17 && image->height == 11 && image->channels == 3);
    static const int first[] = { 202, 159, 90 }, fifth[] = { 156, 141, 96 };
    for (int c = 0; c < 3; c++) {
        assert_true(fabs((double)image->data[c] * 255 - first[c]) < 1e-3);
        assert_true(fabs((double)image->data[4 * 3 + c] * 255 - fifth[c]) < 1e-3);
    }
    wr_image_free(image);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(smallest_is_white_at_every_depth),
        cmocka_unit_test(a_depth_that_is_not_read_is_named),
        cmocka_unit_test(elevations_have_the_scale_of_their_header),
        cmocka_unit_test(narrow_elevations_are_numbers),
        cmocka_unit_test(a_cut_progressive_jpeg_is_refused),
        cmocka_unit_test(missing_elevations_are_filled),
        cmocka_unit_test(no_data_is_found_however_it_is_written),
        cmocka_unit_test(integers_are_the_numbers_of_their_header),
        cmocka_unit_test(an_exr_is_its_display_window),
        cmocka_unit_test(webp_is_turned_and_run_length_bmp_read),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
