/* golden.c - comparison of a sample's picture with the approved one.
       golden NAME...           render samples/NAME.wrinkle and compare with tests/repository/golden/NAME.exr
       golden --bless NAME...   approve the present pictures: inspect them first, and give the reason for
                                the change in the commit
   The picture is made by the program itself, `wrinkle render`, 128 x 128, linear float.

   Grades, over all channels of all pixels, in linear intensity:
       SAME   every bit                      passes
       GOOD   largest difference < 1e-6      passes: rounding on another compiler
       BAD    root mean square < 0.01        fails: it looks alike, but something has changed
       FAIL   anything else, or no picture   fails
   For every other grade than SAME, NAME.exr and NAME-difference.png (the difference magnified to be visible, grey
   where equal) are left in golden-results/ of the build. */
#include "base/error.h"
#include "base/memory.h"
#include "image/image.h"

#include <math.h>
#include <spawn.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

typedef struct Picture {
    int width, height, channels;
    float *pixels; /* [height][width][channels], owned */
} Picture;

typedef struct Difference {
    double max, rms;
    bool same_bits;
} Difference;

static bool read_picture(const char *path, Picture *out, WrError *err)
{
    WrImageFile *file = wr_image_file_open(path, err);
    if (!file) return false;
    WrImagePart part = wr_image_file_part(file, 0);
    size_t count = (size_t)part.width * (size_t)part.height * (size_t)part.channels;
    float *pixels = wr_try_alloc(count, sizeof *pixels, path, err);
    bool ok = pixels && wr_image_file_read(file, 0, pixels, err);
    wr_image_file_close(file);
    if (!ok) {
        wr_free(pixels);
        return false;
    }
    *out = (Picture){ part.width, part.height, part.channels, pixels };
    return true;
}

/* Run the program; its messages are not redirected. */
static bool render(const char *sample, const char *picture, WrError *err)
{
    char program[] = WR_BINARY_DIR "/wrinkle";
    char *arguments[] = {
        program,   "render", (char *)(uintptr_t)sample, "-o", (char *)(uintptr_t)picture, "--size",
        "128x128", NULL
    };
    pid_t child;
    int status = 0;
    if (posix_spawn(&child, program, NULL, NULL, arguments, environ) != 0)
        return wr_fail(err, "%s: cannot be started", program);
    if (waitpid(child, &status, 0) != child || !WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return wr_fail(err, "%s: the program failed (status %#x)", sample, (unsigned)status);
    return true;
}

static Difference compare(const Picture *a, const Picture *b)
{
    size_t count = (size_t)a->width * (size_t)a->height * (size_t)a->channels;
    Difference d = { 0, 0, memcmp(a->pixels, b->pixels, count * sizeof(float)) == 0 };
    double squares = 0;
    for (size_t i = 0; i < count; i++) {
        double e = fabs((double)a->pixels[i] - (double)b->pixels[i]);
        if (isnan(e)) e = HUGE_VAL;
        if (e > d.max) d.max = e;
        squares += e * e;
    }
    d.rms = sqrt(squares / (double)count);
    return d;
}

static const char *grade(const Difference *d)
{
    if (d->same_bits) return "SAME";
    if (d->max < 1e-6) return "GOOD";
    return d->rms < 0.01 ? "BAD" : "FAIL";
}

static unsigned char code(double value)
{
    double c = floor(128.5 + value);
    return (unsigned char)(c > 0 ? (c < 255 ? c : 255) : 0);
}

/* The difference of R, G, B around grey, magnified so that the largest is visible. */
static bool write_difference(const char *path, const Picture *a, const Picture *b, double max,
                             WrError *err)
{
    size_t count = (size_t)a->width * (size_t)a->height;
    double gain = max > 0 && max < HUGE_VAL ? 127 / max : 127 * 8;
    if (gain > 127 * 8000.0) gain = 127 * 8000.0;
    unsigned char *bytes = wr_alloc(count, 3);
    for (size_t i = 0; i < count * 3; i++) {
        size_t at = i / 3 * (size_t)a->channels + (i % 3 < (size_t)a->channels ? i % 3 : 0);
        bytes[i] = code(gain * ((double)a->pixels[at] - (double)b->pixels[at]));
    }
    bool ok = wr_image_write_pixels(path, a->width, a->height, 3, WR_PIXEL_U8, true, bytes, err);
    wr_free(bytes);
    return ok;
}

static bool same_shape(const Picture *a, const Picture *b)
{
    return a->width == b->width && a->height == b->height && a->channels == b->channels;
}

/* Compare the new picture with the approved one and print the grade; true if it passes. */
static bool judge(const char *name, const char *result, WrError *err)
{
    char good[1024], difference[1024];
    snprintf(good, sizeof good, "%s/tests/repository/golden/%s.exr", WR_SOURCE_DIR, name);
    snprintf(difference, sizeof difference, "%s/golden-results/%s-difference.png", WR_BINARY_DIR,
             name);
    Picture now = { 0 }, then = { 0 };
    bool pass = false;
    if (!read_picture(result, &now, err) || !read_picture(good, &then, err)) goto done;
    if (!same_shape(&now, &then)) {
        wr_fail(err, "%s is %dx%d of %d channels, %s is %dx%d of %d", result, now.width, now.height,
                now.channels, good, then.width, then.height, then.channels);
        goto done;
    }
    Difference d = compare(&now, &then);
    pass = d.same_bits || d.max < 1e-6;
    printf("%s: %s, max %.3g, rms %.3g\n", name, grade(&d), d.max, d.rms);
    if (d.same_bits) {
        unlink(result);
        unlink(difference);
    } else if (write_difference(difference, &now, &then, d.max, err)) {
        printf("  picture    %s\n  difference %s\n  good       %s\n", result, difference, good);
        if (!pass) wr_fail(err, "the picture has changed");
    } else {
        pass = false;
    }
done:
    wr_free(now.pixels);
    wr_free(then.pixels);
    return pass;
}

static bool one(const char *name, bool bless, WrError *err)
{
    char sample[1024], result[1024];
    snprintf(sample, sizeof sample, "%s/samples/%s.wrinkle", WR_SOURCE_DIR, name);
    if (bless)
        snprintf(result, sizeof result, "%s/tests/repository/golden/%s.exr", WR_SOURCE_DIR, name);
    else snprintf(result, sizeof result, "%s/golden-results/%s.exr", WR_BINARY_DIR, name);
    if (!render(sample, result, err)) return false;
    if (!bless) return judge(name, result, err);
    printf("%s: blessed; look at %s\n", name, result);
    return true;
}

int main(int count, char **arguments)
{
    bool bless = count > 1 && strcmp(arguments[1], "--bless") == 0;
    int first = bless ? 2 : 1;
    if (count <= first) {
        fprintf(stderr, "usage: golden NAME..., or golden --bless NAME...\n");
        return 2;
    }
    mkdir(WR_BINARY_DIR "/golden-results", 0777);
    if (bless) mkdir(WR_SOURCE_DIR "/tests/repository/golden", 0777);
    int failed = 0;
    for (int i = first; i < count; i++) {
        WrError err = { "" };
        if (one(arguments[i], bless, &err)) continue;
        fprintf(stderr, "golden %s: %s\n", arguments[i], err.text);
        failed++;
    }
    return failed > 0;
}
