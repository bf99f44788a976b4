/* The reader process gets its time and its memory once, and no more. */
#include "reader_help.h"

#include "base/text.h"

/* ---- limits ---- */

static void a_reader_that_says_nothing_is_ended(void **state)
{
    (void)state;
    write_picture("slow.png");
    expect_good("slow.png");
    setenv("WRINKLE_READER_SECONDS", "1", 1);
    WrImageFile *file = open_good("slow.png");
    pid_t child = the_child();
    kill(child, SIGSTOP);
    double begin = wr_clock_seconds();
    expect_unreadable(file, "slow.png: ", "no data was read from it within 1 s");
    double took = wr_clock_seconds() - begin;
    assert_true(took >= 0.99 && took < 5.0);
    expect_no_children(); /* a stopped process can be killed */
    wr_image_file_close(file);
    /* The whole process stopped: opening does not wait for ever either. */
    pid_t process = the_process();
    kill(process, SIGSTOP);
    WrError err = { "" };
    assert_null(wr_image_read("slow.png", &err));
    expect_message(&err, "slow.png: ", "no data was read from it within 1 s");
    kill(process, SIGCONT);
    unsetenv("WRINKLE_READER_SECONDS");
    expect_good("slow.png");
    expect_no_children();
}

/* Processor time in seconds of the reader process's ended children. */
static double seconds_of_children(void)
{
    char path[64];
    unsigned long user = 0, system = 0;
    snprintf(path, sizeof path, "/proc/%d/stat", (int)the_process());
    FILE *file = fopen(path, "r");
    if (!file ||
        fscanf(file, "%*d (%*[^)]) %*c %*d %*d %*d %*d %*d %*u %*u %*u %*u %*u %*u %*u %lu %lu",
               &user, &system) != 2)
        fail_msg("%s cannot be read", path);
    fclose(file);
    return (double)(user + system) / (double)sysconf(_SC_CLK_TCK);
}

/* One face with so many corners that triangulation needs minutes. */
static void write_busy_mesh(WrText *text)
{
    wr_text_add(text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf");
    for (int i = 0; i < 200000; i++) wr_text_addf(text, " %d", i % 3 + 1);
    wr_text_add(text, "\n");
}

static void a_mesh_gets_its_time_once(void **state)
{
    (void)state;
    WrText text = { 0 };
    WrMesh mesh;
    WrError err = { "" };
    write_busy_mesh(&text);
    write_picture("a.png");
    expect_good("a.png"); /* the process has started, with its libraries */
    expect_no_children();
    double before = seconds_of_children();
    setenv("WRINKLE_READER_SECONDS", "2", 1);
    assert_false(wr_mesh_read_bytes("busy.obj", text.data, text.length, &mesh, &err));
    unsetenv("WRINKLE_READER_SECONDS");
    expect_message(&err, "busy.obj: ", "no data was read from it within 2 s");
    expect_no_children();
    assert_true(seconds_of_children() - before < 2.5);
    wr_text_fini(&text);
}

/* ---- nothing comes at all ---- */

typedef bool (*Reading)(WrError *err);

static bool read_picture_file(WrError *err)
{
    return wr_image_read("a.png", err) != NULL;
}

static bool read_mesh_file(WrError *err)
{
    WrMesh mesh;
    return wr_mesh_read("a.png", &mesh, err);
}

static bool read_font_file(WrError *err)
{
    WrFontText text;
    WrFontRequest ask = { .text = "a" };
    return wr_font_shape("a.png", &ask, &text, err);
}

static void *wait_for_nothing(void *reading)
{
    double begin = wr_clock_seconds();
    WrError err = { "" };
    assert_false((*(Reading *)reading)(&err));
    expect_message(&err, "a.png: ", "no data was read from it within 4 s");
    double took = wr_clock_seconds() - begin;
    return took >= 3.99 && took < 7.0 ? NULL : reading;
}

static void every_kind_of_file_waits_for_its_time_once(void **state)
{
    (void)state;
    Reading readings[] = { read_picture_file, read_mesh_file, read_font_file };
    pthread_t threads[3];
    write_picture("a.png");
    expect_good("a.png");
    setenv("WRINKLE_READER_SECONDS", "4", 1);
    pid_t process = the_process();
    kill(process, SIGSTOP);
    for (int i = 0; i < 3; i++) pthread_create(&threads[i], NULL, wait_for_nothing, &readings[i]);
    for (int i = 0; i < 3; i++) {
        void *wrong;
        pthread_join(threads[i], &wrong);
        assert_null(wrong);
    }
    kill(process, SIGCONT);
    unsetenv("WRINKLE_READER_SECONDS");
    expect_good("a.png");
    expect_no_children();
}

static uint32_t crc_of(const unsigned char *bytes, size_t count)
{
    uint32_t crc = 0xffffffffU;
    for (size_t i = 0; i < count; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++) crc = crc & 1 ? 0xedb88320U ^ crc >> 1 : crc >> 1;
    }
    return ~crc;
}

static size_t put32(unsigned char *at, uint32_t value)
{
    for (int i = 0; i < 4; i++) at[i] = (unsigned char)(value >> (24 - 8 * i));
    return 4;
}

static size_t put_chunk(unsigned char *at, const char *name, const void *data, uint32_t length)
{
    put32(at, length);
    memcpy(at + 4, name, 4);
    if (length) memcpy(at + 8, data, length);
    put32(at + 8 + length, crc_of(at + 4, 4 + (size_t)length));
    return 12 + (size_t)length;
}

/* A valid PNG header that claims side x side pixels of four 16-bit channels, with almost no data. */
static void write_claim(const char *path, uint32_t side, bool interlaced)
{
    static const unsigned char data[] = { 0x78, 0x9c, 0x63, 0x60, 0x60, 0x00, 0x00 };
    unsigned char png[256] = "\x89PNG\r\n\x1a\n", header[13] = { 0 };
    size_t n = 8;
    put32(header, side);
    put32(header + 4, side);
    header[8] = 16;
    header[9] = 6;
    header[12] = interlaced;
    n += put_chunk(png + n, "IHDR", header, sizeof header);
    n += put_chunk(png + n, "IDAT", data, sizeof data);
    n += put_chunk(png + n, "IEND", NULL, 0);
    WrError err;
    assert_true(wr_file_write(path, png, n, &err));
}

static void a_claim_of_gigabytes_is_one_sentence(void **state)
{
    (void)state;
    WrError err = { "" };
    write_claim("claim.png", 16384, false);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "truncated or damaged");
    if (SANITIZED) return; /* sanitizers have no memory limit */
    /* An interlaced picture is decoded as a whole: 2 GB. */
    write_claim("claim.png", 16384, true);
    setenv("WRINKLE_READER_MB", "700", 1);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "needs more than 700 MB of memory to be read");
    write_picture("small.png");
    expect_good("small.png");
    unsetenv("WRINKLE_READER_MB");
    write_claim("claim.png", 16385, false);
    assert_null(wr_image_read("claim.png", &err));
    expect_message(&err, "claim.png: ", "each side must be 1..16384");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_reader_that_says_nothing_is_ended),
        cmocka_unit_test(a_mesh_gets_its_time_once),
        cmocka_unit_test(every_kind_of_file_waits_for_its_time_once),
        cmocka_unit_test(a_claim_of_gigabytes_is_one_sentence),
    };
    return cmocka_run_group_tests(tests, enter_folder, remove_folder);
}
