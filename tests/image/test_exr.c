/* Documents by OpenEXR's C library against the same by OpenImageIO: both read the files of each, bit for bit; flipped bytes
   and cut files are one error; all other files are left to OpenImageIO. */
#include "test.h"
#include "test_folder.h"

#include "base/enum_rows.h"
#include "base/error.h"
#include "base/file.h"
#include "base/hash.h"
#include "base/memory.h"
#include "image/exr.h"
#include "image/image.h"
#include "image/oiio.h"
#include "system/fd.h"

#include <fcntl.h>
#include <unistd.h>

/* Sizes around chunks of 16 rows; large enough for a trial only in the last one. */
static const struct {
    int width, height, channels;
} sizes[] = { { 1, 1, 1 }, { 37, 17, 1 }, { 5, 33, 3 }, { 600, 70, 1 }, { 230, 130, 3 } };
#define PARTS WR_LENGTH(sizes)

typedef enum Content { NOISE, FLAT, STEPS, SPECIAL, CONTENTS } Content;

typedef struct Picture {
    int width, channels;
    float *values;
} Picture;

static float value_of(Content content, size_t i, TestRandom *random)
{
    static const float special[] = { -0.0f, 1e-42f, 3.4e38f, -1.0f / 3.0f };
    switch (content) {
    case NOISE: return (float)(test_random(random) * 1e3 - 500);
    case STEPS: return (float)(i / 100 % 9) / 8.0f;
    case SPECIAL: return i % 5 ? special[i % 4] : (i % 2 ? INFINITY : (float)NAN);
    default: return 1.0f;
    }
}

static bool rows_of(void *ctx, int y, int rows, void *out, WrError *err)
{
    (void)err;
    const Picture *picture = ctx;
    const size_t row = (size_t)picture->width * (size_t)picture->channels;
    memcpy(out, picture->values + (size_t)y * row, (size_t)rows * row * sizeof(float));
    return true;
}

static const WrImageAttribute marks[] = { { "wrinkle:version", "2" },
                                          { "wrinkle:scene", "a\nb" },
                                          { "wrinkle:empty", "" } };

static void make_parts(Picture pictures[PARTS], WrImageOut parts[PARTS], Content content)
{
    static const char *const names[] = { "F", "layer:base", "colour", "layer:a b", "normals" };
    TestRandom random = { 5 };
    for (int i = 0; i < PARTS; i++) {
        const size_t count =
            (size_t)sizes[i].width * (size_t)sizes[i].height * (size_t)sizes[i].channels;
        pictures[i] =
            (Picture){ sizes[i].width, sizes[i].channels, wr_alloc(count, sizeof(float)) };
        for (size_t k = 0; k < count; k++) pictures[i].values[k] = value_of(content, k, &random);
        parts[i] = (WrImageOut){ .width = sizes[i].width,
                                 .height = sizes[i].height,
                                 .channels = sizes[i].channels,
                                 .type = WR_PIXEL_F32,
                                 .part_name = names[i],
                                 .attributes = marks,
                                 .attribute_count = i == 0 ? 3 : 0,
                                 .data = true,
                                 .rows = rows_of,
                                 .ctx = &pictures[i] };
    }
}

static bool write_bytes(void *to, const void *bytes, size_t length, int64_t at)
{
    return pwrite(*(int *)to, bytes, length, at) == (ssize_t)length;
}

/* OpenImageIO writes several parts only by name: then a descriptor of the file is the spool. */
static void write_by(const WrCodec *codec, const char *path, const WrImageOut *parts, int count)
{
    char reason[WR_CODEC_REASON] = "";
    int fd = open(path, O_RDWR | O_CREAT | O_TRUNC, 0600);
    const WrByteSink sink = { write_bytes, &fd };
    WrCodecWriter *writer = codec->create(&sink, fd, "openexr", parts, count, reason);
    if (!writer) fail_msg("%s", reason);
    float *rows = wr_alloc(16 * 600 * 3, sizeof *rows);
    for (int i = 0; i < count; i++) {
        assert_true(i == 0 || codec->next(writer, reason));
        for (int y = 0; y < parts[i].height; y += 16) {
            const int some = parts[i].height - y < 16 ? parts[i].height - y : 16;
            rows_of(parts[i].ctx, y, some, rows, NULL);
            assert_true(codec->write(writer, y, some, rows, reason));
        }
    }
    assert_true(codec->finish(writer, true, reason));
    wr_free(rows);
    close(fd);
}

/* Rows from any position, and first channels only. */
static void check_rows(const WrCodec *codec, WrCodecReader *reader, int part,
                       const Picture *picture, TestRandom *random)
{
    char reason[WR_CODEC_REASON] = "";
    const int height = sizes[part].height, all = picture->channels;
    for (int k = 0; k < 12; k++) {
        const int y = k == 0 ? 0 : (int)(test_random_u64(random) % (unsigned)height);
        const int rows =
            k == 0 ? height : 1 + (int)(test_random_u64(random) % (unsigned)(height - y));
        const int channels = 1 + (int)(test_random_u64(random) % (unsigned)all);
        const size_t count = (size_t)rows * (size_t)picture->width;
        float *out = wr_alloc(count * (size_t)channels, sizeof *out);
        if (!codec->read(reader, part, y, rows, channels, out, reason)) fail_msg("%s", reason);
        for (size_t i = 0; i < count; i++)
            for (int c = 0; c < channels; c++)
                if (memcmp(&out[i * (size_t)channels + (size_t)c],
                           &picture->values[((size_t)y * (size_t)picture->width + i) * (size_t)all +
                                            (size_t)c],
                           sizeof(float)) != 0)
                    fail_msg("part %d, row %d: value %zu of channel %d differs", part, y, i, c);
        wr_free(out);
    }
}

static void check_file(const WrCodec *codec, const char *path, const WrImageOut *parts,
                       const Picture *pictures, int count)
{
    char reason[WR_CODEC_REASON] = "";
    TestRandom random = { 3 };
    const int fd = open(path, O_RDONLY);
    WrCodecReader *reader = codec->open(fd, "openexr", WR_IMAGE_PARTS_MAX, false, reason);
    assert_non_null(reader);
    assert_int_equal(codec->parts(reader), count);
    for (int i = 0; i < 3; i++) {
        const char *text = codec->attribute(reader, 0, marks[i].name);
        assert_string_equal(text ? text : "", marks[i].text); /* OpenImageIO has no empty ones */
    }
    assert_null(codec->attribute(reader, 0, "wrinkle:none"));
    for (int i = 0; i < count; i++) {
        const WrImagePart is = codec->part(reader, i)->part;
        assert_string_equal(is.name, parts[i].part_name);
        assert_int_equal(is.width, sizes[i].width);
        assert_int_equal(is.height, sizes[i].height);
        assert_int_equal(is.channels, sizes[i].channels);
        assert_int_equal(is.type, WR_PIXEL_F32);
        assert_string_equal(is.channel_names[0], is.channels == 1 ? "Y" : "R");
        check_rows(codec, reader, i, &pictures[i], &random);
    }
    codec->close(reader);
    close(fd);
}

static void both_libraries_read_the_files_of_each(void **state)
{
    (void)state;
    const WrCodec *const codecs[] = { wr_oiio(NULL), &wr_exr_codec };
    for (int content = 0; content < CONTENTS; content++)
        for (int count = 1; count <= PARTS; count += PARTS - 1) {
            Picture pictures[PARTS];
            WrImageOut parts[PARTS];
            make_parts(pictures, parts, (Content)content);
            assert_true(wr_exr_writes("openexr", parts, count));
            for (int writer = count == 1; writer < 2; writer++) {
                write_by(codecs[writer], "both.exr", parts, count);
                for (int reader = 0; reader < 2; reader++)
                    check_file(codecs[reader], "both.exr", parts, pictures, count);
            }
            for (int i = 0; i < PARTS; i++) wr_free(pictures[i].values);
        }
}

/* The content of a whole file: equal for equal pixels; "" and an error if it cannot be read. */
static bool read_all(const char *path, WrHash *hash, WrError *err)
{
    WrImageFile *file = wr_image_file_open(path, err);
    bool good = file && wr_image_file_parts(file) == PARTS;
    *hash = (WrHash){ 0, 0 };
    for (int i = 0; good && i < PARTS; i++) {
        const WrImagePart is = wr_image_file_part(file, i);
        const size_t count = (size_t)is.width * (size_t)is.height * (size_t)is.channels;
        float *out = wr_alloc(count, sizeof *out);
        good = wr_image_file_read(file, i, out, err);
        *hash = wr_hash_bytes(out, count * sizeof *out, *hash);
        wr_free(out);
    }
    wr_image_file_close(file);
    return good;
}

/* Through the reader process. A stored chunk has no sum, so its changed bytes are other heights; all else fails, or is
   read as before. */
static void damaged_files_are_one_error(void **state)
{
    (void)state;
    Picture pictures[PARTS];
    WrImageOut parts[PARTS];
    TestRandom random = { 17 };
    WrError err = { "" };
    WrHash whole, hash;
    char *bytes;
    size_t length;
    int failed = 0;
    make_parts(pictures, parts, STEPS);
    write_by(&wr_exr_codec, "whole.exr", parts, PARTS);
    assert_true(read_all("whole.exr", &whole, &err));
    assert_true(wr_file_read("whole.exr", WR_FILE_MAX, &bytes, &length, &err));
    for (int i = 0; i < 150; i++) {
        const size_t at = i < 75 ? 600 + (size_t)i : test_random_u64(&random) % length;
        const char before = bytes[at];
        const size_t kept = i % 10 == 9 ? at : length;
        bytes[at] = (char)(before ^ (1 << (i % 8)));
        assert_true(wr_file_write("harmed.exr", bytes, kept, &err));
        bytes[at] = before;
        err.text[0] = '\0';
        if (read_all("harmed.exr", &hash, &err)) continue;
        failed++;
        if (!err.text[0]) continue; /* fewer parts */
        assert_memory_equal(err.text, "harmed.exr: ", 12);
        assert_null(strchr(err.text, '\n'));
        assert_null(strstr(err.text, "crashed"));
    }
    assert_true(failed > 60);
    wr_free(bytes);
    for (int i = 0; i < PARTS; i++) wr_free(pictures[i].values);
}

static void other_files_are_left_to_openimageio(void **state)
{
    (void)state;
    Picture pictures[PARTS];
    WrImageOut parts[PARTS];
    char reason[WR_CODEC_REASON] = "x";
    make_parts(pictures, parts, NOISE);
    parts[0].attributes++, parts[0].attribute_count--; /* not of a document */
    assert_false(wr_exr_writes("openexr", parts, PARTS));
    write_by(&wr_exr_codec, "other.exr", parts, PARTS);
    int fd = open("other.exr", O_RDONLY);
    assert_null(wr_exr_codec.open(fd, "openexr", WR_IMAGE_PARTS_MAX, false, reason));
    assert_string_equal(reason, "");
    close(fd);
    WrHash hash;
    WrError err = { "" };
    if (!read_all("other.exr", &hash, &err)) fail_msg("%s", err.text);
    /* a document that another program saved as halves */
    parts[0].attributes--, parts[0].attribute_count++;
    for (int i = 0; i < PARTS; i++) parts[i].half = true;
    assert_false(wr_exr_writes("openexr", parts, PARTS));
    write_by(wr_oiio(NULL), "half.exr", parts, PARTS);
    if (!read_all("half.exr", &hash, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < PARTS; i++) wr_free(pictures[i].values);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(both_libraries_read_the_files_of_each),
        cmocka_unit_test(damaged_files_are_one_error),
        cmocka_unit_test(other_files_are_left_to_openimageio),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
