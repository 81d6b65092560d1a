/* Images: what is read, what is written, and all that must be refused. */
#define _GNU_SOURCE
#include "image.h"

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <stdint.h>
#include <cmocka.h>

#include <dirent.h>
#include <fcntl.h>
#include <locale.h>
#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

/* ---- A folder for the files of one test ---------------------------------------------------------------- */

static char folder[256];

static const char *in_folder(const char *name) {
    static char paths[4][512]; /* the last four results stay valid */
    static int next;
    char *path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", folder, name);
    return path;
}

static int folder_make(void **state) {
    (void)state;
    const char *temporary = getenv("TMPDIR");
    snprintf(folder, sizeof folder, "%s/texel-XXXXXX", temporary ? temporary : "/tmp");
    return mkdtemp(folder) ? 0 : -1;
}

/* The number of files in the folder; removes them if asked to. */
static int folder_count(bool empty) {
    DIR *directory = opendir(folder);
    int count = 0;
    for (struct dirent *entry; (entry = readdir(directory));) {
        if (!strcmp(entry->d_name, ".") || !strcmp(entry->d_name, "..")) continue;
        count++;
        if (empty) remove(in_folder(entry->d_name));
    }
    closedir(directory);
    return count;
}

static int folder_remove(void **state) {
    (void)state;
    folder_count(true);
    return rmdir(folder);
}

typedef struct {
    size_t size;
    unsigned char bytes[1 << 17];
} Bytes;

static Bytes scratch; /* of the test that runs */

static void file_read(const char *path, Bytes *bytes) {
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    bytes->size = fread(bytes->bytes, 1, sizeof bytes->bytes, file);
    fclose(file);
    assert_true(bytes->size < sizeof bytes->bytes);
}

static void file_write(const char *path, const void *bytes, size_t size) {
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    assert_int_equal(fwrite(bytes, 1, size, file), size);
    assert_int_equal(fclose(file), 0);
}

/* ---- PNG files made by hand, so that nothing rests on the library under test ----------------------------
 */

static void put(Bytes *out, const void *bytes, size_t size) {
    memcpy(out->bytes + out->size, bytes, size);
    out->size += size;
}

static void put_number(Bytes *out, uint32_t x) {
    put(out, (unsigned char[4]){x >> 24, x >> 16 & 255, x >> 8 & 255, x & 255}, 4);
}

static void put_chunk(Bytes *out, const char *name, const void *data, size_t size) {
    put_number(out, (uint32_t)size);
    size_t start = out->size;
    put(out, name, 4);
    put(out, data, size);
    uint32_t crc = ~0u;
    for (size_t i = start; i < out->size; i++) {
        crc ^= out->bytes[i];
        for (int bit = 0; bit < 8; bit++) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    put_number(out, ~crc);
}

/* An 8-bit PNG of channels 1 (grey), 3 or 4, with one chunk more if extra is not NULL. pixels: top row first.
 */
static void png_make(const char *path, uint32_t width, uint32_t height, int channels,
                     const unsigned char *pixels, const char *extra, const void *data, size_t size) {
    static const unsigned char colour_types[] = {0, 0, 4, 2, 6};
    static Bytes file, rows, stream;
    file.size = rows.size = stream.size = 0;
    put(&file, "\x89PNG\r\n\x1a\n", 8);
    Bytes *head = &stream;
    put_number(head, width);
    put_number(head, height);
    put(head, (unsigned char[5]){8, colour_types[channels], 0, 0, 0}, 5);
    put_chunk(&file, "IHDR", head->bytes, head->size);
    if (extra) put_chunk(&file, extra, data, size);
    if (pixels) {
        for (uint32_t y = 0; y < height; y++) {
            put(&rows, "\0", 1); /* this row is not filtered */
            put(&rows, pixels + (size_t)y * width * channels, (size_t)width * channels);
        }
        uint32_t a = 1, b = 0;
        for (size_t i = 0; i < rows.size; i++) a = (a + rows.bytes[i]) % 65521, b = (b + a) % 65521;
        stream.size = 0; /* zlib's wrapping of one block that is not compressed */
        unsigned low = rows.size & 255, high = (unsigned)rows.size >> 8;
        put(&stream, (unsigned char[7]){0x78, 1, 1, low, high, 255 - low, 255 - high}, 7);
        put(&stream, rows.bytes, rows.size);
        put_number(&stream, b << 16 | a);
    } else
        stream.size = 0;
    put_chunk(&file, "IDAT", stream.bytes, stream.size);
    put_chunk(&file, "IEND", "", 0);
    file_write(path, file.bytes, file.size);
}

/* ---- Images for the tests ------------------------------------------------------------------------------ */

/* Different everywhere, in 0..1, and not symmetric in any direction. */
static Image pattern(int width, int height, int channels) {
    Image image = image_create(width, height, channels);
    size_t count = (size_t)width * height * channels;
    for (size_t i = 0; i < count; i++) image.pixels[i] = (float)(i * 37 % 101) / 101 + (float)i / count / 128;
    return image;
}

static void assert_image(const Image *image, int width, int height, int channels, int bits) {
    assert_int_equal(image->width, width);
    assert_int_equal(image->height, height);
    assert_int_equal(image->channels, channels);
    assert_int_equal(image->bits, bits);
}

/* ---- Refusals ------------------------------------------------------------------------------------------ */

static void assert_says(const char *reason, const char *part) {
    if (!reason || !strstr(reason, part)) fail_msg("expected \"...%s...\", got \"%s\"", part, reason);
    assert_null(strchr(reason, '\n'));
}

/* Reading must be refused, for a reason that holds `part`, in silence, and must leave the image alone. */
static void assert_refused(const char *path, ImageKind kind, const char *part) {
    const Image before = {.width = 7, .height = 8, .channels = 9, .bits = 10};
    Image image = before;
    fflush(stderr);
    char log[512];
    snprintf(log, sizeof log, "%s/stderr", folder);
    int saved = dup(2), caught = open(log, O_CREAT | O_TRUNC | O_WRONLY, 0600);
    dup2(caught, 2);
    const char *reason = image_read(&image, path, kind);
    ssize_t written = write(2, "!", 1); /* standard error must be itself again */
    dup2(saved, 2);
    close(saved);
    close(caught);
    assert_says(reason, part);
    assert_memory_equal(&image, &before, sizeof image);
    assert_int_equal(written, 1);
    struct stat about;
    stat(log, &about);
    assert_int_equal(about.st_size, 1);
}

static void refuses_what_is_no_image(void **state) {
    (void)state;
    assert_refused(in_folder("missing.png"), IMAGE_COLOUR, "No such file");
    assert_refused(folder, IMAGE_COLOUR, "Is a directory");
    assert_refused("/dev/null", IMAGE_COLOUR, "not a regular file");
    const char *endings[] = {"a.png", "a.jpg", "a.exr", "a.hdr", "a.tga", "a.txt", "a"};
    for (size_t i = 0; i < sizeof endings / sizeof *endings; i++) {
        const char *path = in_folder(endings[i]);
        file_write(path, "", 0);
        assert_refused(path, IMAGE_COLOUR, "empty");
        const char words[] = "This is a letter to a friend, and no image.\nIt has two lines.\n";
        file_write(path, words, strlen(words));
        assert_refused(path, IMAGE_COLOUR, "");
        file_write(path, "\x89PNG\r\n\x1a\n", 8);
        assert_refused(path, IMAGE_COLOUR, "truncated");
        file_write(path, "\xff\xd8\xff\xd9", 4);
        assert_refused(path, IMAGE_COLOUR, "");
    }
    if (geteuid() != 0) { /* root may read everything */
        chmod(in_folder("a.png"), 0);
        assert_refused(in_folder("a.png"), IMAGE_COLOUR, "Permission denied");
    }
}

/* Whatever the format, a file that ends too early is never taken for whole. */
static void refuses_truncated_files(void **state) {
    (void)state;
    const char *names[] = {"t8.png", "t16.png", "t.jpg", "t.exr", "t.hdr"};
    Image image = pattern(61, 47, 3);
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        const char *path = in_folder(names[i]);
        assert_null(i == 1 ? image_write_raw(&image, path, 16) : image_write(&image, path));
        file_read(path, &scratch);
        for (int part = 1; part < 20; part++) {
            file_write(path, scratch.bytes, scratch.size * part / 20);
            assert_refused(path, IMAGE_COLOUR, "");
        }
        file_write(path, scratch.bytes, scratch.size - 1);
        assert_refused(path, IMAGE_COLOUR, "truncated");
    }
    image_destroy(&image);
}

static void demands_the_end_of_a_jpeg(void **state) {
    (void)state;
    Image image = pattern(33, 20, 3), read;
    const char *path = in_folder("end.jpg");
    assert_null(image_write(&image, path));
    file_read(path, &scratch);
    size_t size = scratch.size;
    file_write(path, scratch.bytes, size - 2);
    assert_refused(path, IMAGE_COLOUR, "JPEG ends with an end marker");
    memset(scratch.bytes + size - 2, 0, 1000); /* what a disk leaves of a file that was never finished */
    file_write(path, scratch.bytes, size + 1000);
    assert_refused(path, IMAGE_COLOUR, "JPEG ends with an end marker");
    memcpy(scratch.bytes + size - 2, "\xff\xd9", 2); /* but zeros after the end are harmless */
    file_write(path, scratch.bytes, size + 1000);
    assert_null(image_read(&read, path, IMAGE_COLOUR));
    assert_image(&read, 33, 20, 3, 8);
    image_destroy(&read);
    image_destroy(&image);
}

static void refuses_broken_pixels(void **state) {
    (void)state;
    Image image = pattern(61, 47, 3);
    const char *path = in_folder("broken.png");
    assert_null(image_write(&image, path));
    file_read(path, &scratch);
    for (int i = 0; i < 8; i++) scratch.bytes[scratch.size / 2 + i] ^= 0x55;
    file_write(path, scratch.bytes, scratch.size);
    assert_refused(path, IMAGE_COLOUR, "broken");
    image_destroy(&image);
}

/* Headers that promise nothing, or too much: refused before any memory is asked for. */
static void refuses_sizes(void **state) {
    (void)state;
    struct rusage before, after;
    getrusage(RUSAGE_SELF, &before);
    const char *path = in_folder("size.png");
    png_make(path, 0, 0, 3, NULL, NULL, NULL, 0);
    assert_refused(path, IMAGE_COLOUR, "");
    png_make(path, 1000000, 1000000, 3, NULL, NULL, NULL, 0);
    assert_refused(path, IMAGE_COLOUR, "too large: 1000000x1000000");
    png_make(path, 16385, 1, 1, NULL, NULL, NULL, 0);
    assert_refused(path, IMAGE_COLOUR, "too large: 16385x1");
    png_make(path, 16384, 16384, 3, NULL, NULL, NULL, 0);
    assert_refused(path, IMAGE_COLOUR, "more than 1 GiB");
    path = in_folder("size.hdr");
    const char zero[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 0 +X 0\n";
    file_write(path, zero, strlen(zero));
    assert_refused(path, IMAGE_COLOUR, "");
    const char huge[] = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1000000 +X 1000000\n";
    file_write(path, huge, strlen(huge));
    assert_refused(path, IMAGE_COLOUR, "too large: 1000000x1000000");
    path = in_folder("size.ppm");
    file_write(path, "P6\n1000000 1000000\n255\n", 23);
    assert_refused(path, IMAGE_COLOUR, "too large: 1000000x1000000");
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 64 * 1024); /* KiB */

    const char *whole = in_folder("whole.exr"); /* and one in EXR, whose size is a box: xMax, yMax of it */
    Image image = pattern(4, 3, 1);
    assert_null(image_write(&image, whole));
    file_read(whole, &scratch);
    unsigned char *box = memmem(scratch.bytes, scratch.size, "dataWindow\0box2i", 17);
    assert_non_null(box);
    const unsigned char corner[8] = {0x3f, 0x42, 0x0f, 0, 0x3f, 0x42, 0x0f, 0}; /* 999999, 999999 */
    memcpy(box + 17 + 4 + 8, corner, 8);
    file_write(whole, scratch.bytes, scratch.size);
    assert_refused(whole, IMAGE_COLOUR, "");
    getrusage(RUSAGE_SELF, &after);
    assert_true(after.ru_maxrss - before.ru_maxrss < 128 * 1024);
    image_destroy(&image);
}

static void refuses_what_is_not_finite(void **state) {
    (void)state;
    const float bad[] = {NAN, INFINITY, -INFINITY};
    const char *path = in_folder("bad.exr");
    for (int i = 0; i < 3; i++) {
        Image image = pattern(5, 4, 3);
        image_at(&image, 2, 0)[1] = bad[i];
        assert_null(image_write(&image, path));
        assert_refused(path, IMAGE_COLOUR, "not finite at column 2, row 3"); /* the file's top row is 0 */
        assert_refused(path, IMAGE_RAW, "not finite at column 2, row 3");
        image_destroy(&image);
    }
}

/* In a program of its own (main, below): a mere fork lacks the threads that OpenImageIO waits for at exit. */
static void load_ends_the_program(void **state) {
    (void)state;
    const char *log = in_folder("said");
    pid_t child = fork();
    if (child == 0) {
        dup2(open(log, O_CREAT | O_WRONLY, 0600), 2);
        execl("/proc/self/exe", "loader", in_folder("nowhere.png"), (char *)NULL);
        _exit(99);
    }
    int status;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status));
    assert_int_equal(WEXITSTATUS(status), 1);
    file_read(log, &scratch);
    scratch.bytes[scratch.size] = 0;
    const char *said = (char *)scratch.bytes;
    assert_non_null(strstr(said, in_folder("nowhere.png: No such file or directory\n")));
    assert_ptr_equal(strchr(said, '\n'), said + scratch.size - 1); /* one line */
}

/* ---- What is read -------------------------------------------------------------------------------------- */

static void row_0_is_the_bottom(void **state) {
    (void)state;
    const unsigned char pixels[] = {255, 0, 0, /* the file's first row is what one sees on top: red */
                                    0,   0, 255};
    png_make(in_folder("rows.png"), 1, 2, 3, pixels, NULL, NULL, 0);
    Image image = image_load(in_folder("rows.png"), IMAGE_COLOUR);
    assert_image(&image, 1, 2, 3, 8);
    const float blue[] = {0, 0, 1}, red[] = {1, 0, 0};
    assert_memory_equal(image_at(&image, 0, 0), blue, sizeof blue);
    assert_memory_equal(image_at(&image, 0, 1), red, sizeof red);
    const char *names[] = {"back.png", "back.exr", "back.hdr"};
    for (int i = 0; i < 3; i++) { /* and saving turns it the other way */
        image_save(&image, in_folder(names[i]));
        Image back = image_load(in_folder(names[i]), IMAGE_COLOUR);
        assert_memory_equal(back.pixels, image.pixels, 6 * sizeof(float));
        image_destroy(&back);
    }
    image_destroy(&image);
}

static void colour_is_decoded(void **state) {
    (void)state;
    const unsigned char pixels[] = {200, 100, 50, 128, 7, 8, 9, 0}; /* RGBA; where alpha is 0, colour stays */
    const char *path = in_folder("rgba.png");
    png_make(path, 2, 1, 4, pixels, NULL, NULL, 0);
    Image colour = image_load(path, IMAGE_COLOUR), raw = image_load(path, IMAGE_RAW);
    Image height = image_load(path, IMAGE_HEIGHT);
    assert_image(&colour, 2, 1, 3, 8);
    assert_image(&raw, 2, 1, 4, 8);
    assert_image(&height, 2, 1, 1, 8);
    for (int x = 0; x < 2; x++) {
        for (int c = 0; c < 3; c++)
            assert_true(image_at(&colour, x, 0)[c] == (float)srgb_decode(pixels[4 * x + c] / 255.0));
        for (int c = 0; c < 4; c++)
            assert_true(image_at(&raw, x, 0)[c] == (float)(pixels[4 * x + c] / 255.0));
        assert_true(image_at(&height, x, 0)[0] == (float)(pixels[4 * x] / 255.0));
    }
    image_destroy(&colour);
    image_destroy(&raw);
    image_destroy(&height);

    png_make(path, 1, 1, 1, pixels, NULL, NULL, 0); /* grey becomes three channels */
    colour = image_load(path, IMAGE_COLOUR);
    assert_image(&colour, 1, 1, 3, 8);
    for (int c = 0; c < 3; c++) assert_true(colour.pixels[c] == (float)srgb_decode(200 / 255.0));
    image_destroy(&colour);

    const unsigned char linear[4] = {0, 1, 0x86, 0xa0}; /* gamma 1, as the file says it: 100000 */
    png_make(path, 1, 1, 3, pixels, "gAMA", linear, 4);
    colour = image_load(path, IMAGE_COLOUR);
    assert_true(colour.pixels[0] == (float)(200 / 255.0));
    image_destroy(&colour);

    const unsigned char usual[4] = {0, 0, 0xb1, 0x8f}; /* 45455: how old files say sRGB */
    png_make(path, 1, 1, 3, pixels, "gAMA", usual, 4);
    colour = image_load(path, IMAGE_COLOUR);
    assert_true(colour.pixels[0] == (float)srgb_decode(200 / 255.0));
    image_destroy(&colour);
}

static void srgb_is_the_standard(void **state) {
    (void)state;
    assert_float_equal(srgb_decode(0.5), 0.21404114048223255, 1e-15);
    assert_float_equal(srgb_encode(0.18), 0.46135612950044164, 1e-14);
    assert_float_equal(srgb_encode(0.002), 0.02584, 1e-15);
    for (int i = 0; i <= 1000; i++)
        assert_float_equal(srgb_encode(srgb_decode(i / 1000.0)), i / 1000.0, 1e-7);
    for (int i = -100; i <= 1100000; i++) { /* the table against the formula */
        float x = i / 1e6f;
        double code = 255 * srgb_encode(fmin(fmax(x, 0), 1));
        if (fabs(srgb_byte(x) - code) > 0.5 + 1e-4)
            fail_msg("srgb_byte(%g) = %d, not %g", x, srgb_byte(x), code);
    }
    assert_int_equal(srgb_byte(NAN), 0);
    assert_int_equal(srgb_byte(INFINITY), 255);
    assert_int_equal(srgb_byte(-INFINITY), 0);
}

/* ---- What is written ----------------------------------------------------------------------------------- */

static void bytes_survive(void **state) {
    (void)state;
    unsigned char codes[256], *back = scratch.bytes;
    for (int i = 0; i < 256; i++) codes[i] = (unsigned char)i;
    png_make(in_folder("codes.png"), 16, 16, 1, codes, NULL, NULL, 0);
    Image colour = image_load(in_folder("codes.png"), IMAGE_COLOUR);
    image_save(&colour, in_folder("saved.png")); /* decoded, then encoded */
    Image raw = image_load(in_folder("codes.png"), IMAGE_RAW);
    assert_null(image_write_raw(&raw, in_folder("raw.png"), 8));
    const char *names[] = {"saved.png", "raw.png"};
    for (int n = 0; n < 2; n++) {
        Image saved = image_load(in_folder(names[n]), IMAGE_RAW);
        assert_image(&saved, 16, 16, n == 0 ? 3 : 1, 8);
        for (int i = 0; i < 256; i++)
            back[i] = (unsigned char)lrintf(image_at(&saved, i % 16, 15 - i / 16)[0] * 255);
        assert_memory_equal(back, codes, 256);
        image_destroy(&saved);
    }
    image_destroy(&colour);
    image_destroy(&raw);
}

static void sixteen_bits_survive(void **state) {
    (void)state;
    Image image = image_create(256, 256, 1);
    for (int i = 0; i < 65536; i++) image.pixels[i] = (float)(i / 65535.0);
    const char *path = in_folder("deep.png");
    assert_null(image_write_raw(&image, path, 16));
    Image read = image_load(path, IMAGE_HEIGHT);
    assert_image(&read, 256, 256, 1, 16);
    assert_memory_equal(read.pixels, image.pixels, 65536 * sizeof(float));
    image_destroy(&read);
    read = image_load(path, IMAGE_COLOUR);
    assert_image(&read, 256, 256, 3, 16);
    for (int i = 0; i < 65536; i += 97)
        for (int c = 0; c < 3; c++) assert_true(read.pixels[3 * i + c] == (float)srgb_decode(i / 65535.0));
    image_destroy(&read);
    image_destroy(&image);
}

static void floats_survive(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        Image image = pattern(9, 5, channels);
        image.pixels[0] = -3.25f;
        image.pixels[1] = 1e30f;
        const char *path = in_folder("f.exr");
        assert_null(image_write(&image, path));
        Image read = image_load(path, IMAGE_RAW);
        assert_image(&read, 9, 5, channels, 32);
        assert_memory_equal(read.pixels, image.pixels, (size_t)9 * 5 * channels * sizeof(float));
        image_destroy(&read);
        assert_null(image_write_raw(&image, path, 32));
        read = image_load(path, IMAGE_COLOUR); /* linear: nothing is decoded */
        assert_true(image_at(&read, 8, 4)[0] == image_at(&image, 8, 4)[0]);
        assert_true(image_at(&read, 8, 4)[2] == image_at(&image, 8, 4)[channels < 3 ? 0 : 2]);
        image_destroy(&read);
        image_destroy(&image);
    }
}

/* Formats that lose something lose no more than they must. */
static void jpeg_and_hdr_come_close(void **state) {
    (void)state;
    for (int channels = 1; channels <= 4; channels++) {
        Image image = image_create(32, 32, channels);
        for (int y = 0; y < 32; y++)
            for (int x = 0; x < 32; x++)
                for (int c = 0; c < channels; c++) image_at(&image, x, y)[c] = 0.1f + 0.01f * x + 0.015f * y;
        const char *names[] = {"c.jpg", "c.hdr"};
        for (int n = 0; n < 2; n++) {
            assert_null(image_write(&image, in_folder(names[n])));
            Image read = image_load(in_folder(names[n]), IMAGE_COLOUR);
            assert_image(&read, 32, 32, 3, n == 0 ? 8 : 32);
            for (int i = 0; i < 32 * 32; i++)
                assert_float_equal(read.pixels[3 * i], image.pixels[channels * i], 0.02);
            image_destroy(&read);
        }
        image_destroy(&image);
    }
}

static void clipped_where_it_must(void **state) {
    (void)state;
    Image image = image_create(4, 1, 1);
    const float values[] = {-1, 2, NAN, 0.5f}, kept[] = {0, 1, 0};
    memcpy(image.pixels, values, sizeof values);
    for (int bits = 8; bits <= 16; bits += 8) {
        assert_null(image_write_raw(&image, in_folder("clip.png"), bits));
        Image read = image_load(in_folder("clip.png"), IMAGE_RAW);
        assert_memory_equal(read.pixels, kept, sizeof kept);
        image_destroy(&read);
    }
    image_destroy(&image);
}

static void scale_and_base_survive(void **state) {
    (void)state;
    Image image = pattern(3, 2, 1);
    const char *names[] = {"m.png", "m.exr"};
    for (int n = 0; n < 2; n++) {
        const char *path = in_folder(names[n]);
        image.scale = 0.1;
        image.base = 1 / 3.0;
        assert_null(image_write_raw(&image, path, 16));
        Image read = image_load(path, IMAGE_HEIGHT);
        assert_true(read.scale == 0.1 && read.base == 1 / 3.0); /* to the last bit */
        image_destroy(&read);
        read = image_load(path, IMAGE_COLOUR);
        assert_true(isnan(read.scale) && isnan(read.base));
        image_destroy(&read);
        image.base = NAN; /* one without the other */
        image.scale = 1e-9;
        assert_null(image_write_raw(&image, path, 16));
        read = image_load(path, IMAGE_HEIGHT);
        assert_true(read.scale == 1e-9 && isnan(read.base));
        image_destroy(&read);
    }
    image_destroy(&image);
}

static void refuses_bad_scale_and_base(void **state) {
    (void)state;
    const char *bad[] = {"deep", "", "0.1x", "1,5", "nan", "inf", "1e999"};
    const char *path = in_folder("meta.png");
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char scale[40] = "texel:scale", base[40] = "texel:base"; /* a text chunk: name, zero, text */
        strcpy(scale + 12, bad[i]);
        strcpy(base + 11, bad[i]);
        png_make(path, 1, 1, 1, (unsigned char *)"x", "tEXt", scale, 12 + strlen(bad[i]));
        assert_refused(path, IMAGE_HEIGHT, "texel:scale");
        assert_refused(path, IMAGE_HEIGHT, bad[i]);
        Image image;
        assert_null(image_read(&image, path, IMAGE_COLOUR)); /* where it does not matter */
        image_destroy(&image);
        png_make(path, 1, 1, 1, (unsigned char *)"x", "tEXt", base, 11 + strlen(bad[i]));
        assert_refused(path, IMAGE_HEIGHT, "texel:base");
    }
}

static void writes_whole_or_not_at_all(void **state) {
    (void)state;
    folder_count(true);
    Image image = pattern(64, 64, 3);
    assert_says(image_write(&image, in_folder("no/such/folder.png")), "cannot be written: No such file");
    assert_says(image_write(&image, in_folder("a.xyz")), "cannot be written");
    assert_says(image_write(&image, in_folder("png")), "cannot be written");
    assert_says(image_write_raw(&image, in_folder("a.jpg"), 8), "cannot be written");
    assert_int_equal(folder_count(false), 0);
    assert_int_equal(mkdir(in_folder("d.png"), 0700), 0);
    assert_says(image_write(&image, in_folder("d.png")), "cannot be written: Is a directory");
    assert_int_equal(rmdir(in_folder("d.png")), 0);
    file_write(in_folder("f"), "", 0);
    assert_says(image_write(&image, in_folder("f/a.png")), "cannot be written: Not a directory");
    assert_int_equal(folder_count(true), 1);

    assert_null(image_write(&image, in_folder("old.exr"))); /* a full disk leaves the old file as it was */
    file_read(in_folder("old.exr"), &scratch);
    struct rlimit limit, small = {1000, RLIM_INFINITY};
    getrlimit(RLIMIT_FSIZE, &limit);
    small.rlim_max = limit.rlim_max;
    signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    image.pixels[0] = 17;
    const char *reason = image_write(&image, in_folder("old.exr"));
    setrlimit(RLIMIT_FSIZE, &limit);
    assert_says(reason, "cannot be written: File too large");
    assert_int_equal(folder_count(false), 1);
    static Bytes now;
    file_read(in_folder("old.exr"), &now);
    assert_int_equal(now.size, scratch.size);
    assert_memory_equal(now.bytes, scratch.bytes, now.size);

    if (geteuid() != 0) {
        chmod(folder, 0500);
        reason = image_write(&image, in_folder("a.png"));
        chmod(folder, 0700);
        assert_says(reason, "cannot be written: Permission denied");
    }
    image_destroy(&image);
}

static void same_image_same_file(void **state) {
    (void)state;
    folder_count(true);
    Image image = pattern(20, 10, 3);
    image.scale = 0.5;
    const char *names[] = {"s.png", "s.jpg", "s.exr", "s.hdr"};
    static Bytes again;
    for (int n = 0; n < 4; n++) {
        const char *path = in_folder(names[n]);
        assert_null(image_write(&image, path));
        file_read(path, &scratch);
        assert_null(image_write(&image, path));
        file_read(path, &again);
        assert_int_equal(again.size, scratch.size);
        assert_memory_equal(again.bytes, scratch.bytes, again.size);
        char today[16]; /* nor does it differ tomorrow */
        time_t now = time(NULL);
        strftime(today, sizeof today, "%Y:%m:%d", gmtime(&now));
        assert_null(memmem(again.bytes, again.size, today, 8)); /* to the month: time zones differ */
        assert_null(memmem(again.bytes, again.size, "tIME", 4));
        struct stat about;
        stat(path, &about);
        mode_t mask = umask(0);
        umask(mask);
        assert_int_equal(about.st_mode & 0777, 0666 & ~mask);
    }
    assert_int_equal(folder_count(false), 4);
    image_destroy(&image);
}

/* ---- Relief textures ----------------------------------------------------------------------------------- */

/* A skew basis of numbers that no decimal holds, with f below the plane of a and b. */
static Basis skew(void) {
    return (Basis){.origin = v3(-1 / 3.0, 1e-300, 1e6 / 7),
                   .a = v3(sqrt(2), 0.1, -1e-3),
                   .b = v3(-0.7, PI, 1 / 7.0),
                   .f = v3(0.25, 0.1, -exp(1)),
                   .unit = "mm"};
}

static Image relief_height(int width, int height) {
    Image image = pattern(width, height, 1);
    for (int i = 0; i < width * height; i++) image.pixels[i] /= 2;
    image.pixels[0] = 0; /* where a program that takes height for alpha would lose the colour */
    image.pixels[width * height - 1] = 1;
    image.scale = 0.1, image.base = 1 / 3.0;
    image.basis = skew();
    image.hollow = true;
    return image;
}

static void assert_basis(const Basis *one, const Basis *other) {
    const Vec3 *a[] = {&one->origin, &one->a, &one->b, &one->f};
    const Vec3 *b[] = {&other->origin, &other->a, &other->b, &other->f};
    for (int i = 0; i < 4; i++) /* to the last bit */
        assert_true(a[i]->x == b[i]->x && a[i]->y == b[i]->y && a[i]->z == b[i]->z);
    assert_string_equal(one->unit, other->unit);
}

/* Each number within `colour` codes of sRGB, and within `height`. */
static void assert_relief(const char *path, int bits, const Image *colour, const Image *height,
                          double colour_bound, double height_bound) {
    Image c = image_load(path, IMAGE_COLOUR), h = image_load(path, IMAGE_HEIGHT);
    assert_image(&c, colour->width, colour->height, 3, bits);
    assert_image(&h, colour->width, colour->height, 1, bits);
    for (int i = 0; i < 3 * c.width * c.height; i++)
        assert_float_equal(srgb_encode(c.pixels[i]), srgb_encode(colour->pixels[i]), colour_bound);
    for (int i = 0; i < h.width * h.height; i++)
        assert_float_equal(h.pixels[i], height->pixels[i], height_bound);
    assert_true(h.scale == height->scale && h.base == height->base && h.hollow == height->hollow);
    assert_basis(&h.basis, &height->basis);
    assert_true(isnan(c.scale) && isnan(c.base) && isnan(c.basis.a.x) && !c.hollow);
    assert_true(c.relief && h.relief);
    image_destroy(&c), image_destroy(&h);
}

static void reliefs_survive(void **state) {
    (void)state;
    Image colour = pattern(13, 7, 3), height = relief_height(13, 7);
    const char *png = in_folder("r.png"), *exr = in_folder("r.exr");
    assert_null(image_write_relief(&colour, &height, png, 8));
    assert_relief(png, 8, &colour, &height, 0.501 / 255, 0.501 / 255);
    assert_null(image_write_relief(&colour, &height, png, 16));
    assert_relief(png, 16, &colour, &height, 0.501 / 65535, 0.501 / 65535);
    assert_null(image_write_relief(&colour, &height, exr, 32));
    assert_relief(exr, 32, &colour, &height, 0, 0);

    file_read(exr, &scratch); /* no other program may take the fourth channel for alpha */
    assert_non_null(memmem(scratch.bytes, scratch.size, "height\0\2\0\0\0", 11));
    assert_null(memmem(scratch.bytes, scratch.size, "A\0\2\0\0\0", 6));
    Image raw = image_load(exr, IMAGE_RAW); /* and the four channels as they are stored */
    assert_image(&raw, 13, 7, 4, 32);
    assert_false(raw.relief);
    for (int i = 0; i < 13 * 7; i++) {
        assert_memory_equal(raw.pixels + 4 * i, colour.pixels + 3 * i, 3 * sizeof(float));
        assert_true(raw.pixels[4 * i + 3] == height.pixels[i]);
    }
    image_destroy(&raw), image_destroy(&colour), image_destroy(&height);
}

/* What is read is written again as the same bytes, where heights are 0 too; and nothing drifts. */
static void reliefs_are_read_and_written_alike(void **state) {
    (void)state;
    static Bytes again;
    const char *names[] = {"a8.png", "a16.png", "a.exr"};
    Image colour = pattern(13, 7, 3), height = relief_height(13, 7);
    for (int n = 0; n < 3; n++) {
        const char *path = in_folder(names[n]);
        assert_null(image_write_relief(&colour, &height, path, n == 0 ? 8 : 16));
        file_read(path, &scratch);
        Image c = image_load(path, IMAGE_COLOUR), h = image_load(path, IMAGE_HEIGHT);
        assert_null(image_write_relief(&c, &h, path, n == 0 ? 8 : 16));
        file_read(path, &again);
        assert_int_equal(again.size, scratch.size);
        assert_memory_equal(again.bytes, scratch.bytes, again.size);
        image_destroy(&c), image_destroy(&h);
    }
    image_destroy(&colour), image_destroy(&height);
}

/* Every code that a file can hold, at height 0: 8 and 16 bits, decoded, then encoded. */
static void colour_survives_where_height_is_0(void **state) {
    (void)state;
    const char *path = in_folder("zero.png");
    for (int bits = 8; bits <= 16; bits += 8) {
        int side = bits == 8 ? 16 : 256, top = side * side - 1;
        Image colour = image_create(side, side, 3), height = image_create(side, side, 1);
        for (int i = 0; i <= top; i++)
            for (int c = 0; c < 3; c++)
                colour.pixels[3 * i + c] = (float)srgb_decode((c ? top - i : i) / (double)top);
        assert_null(image_write_relief(&colour, &height, path, bits));
        Image raw = image_load(path, IMAGE_RAW);
        assert_image(&raw, side, side, 4, bits);
        for (int i = 0; i <= top; i++)
            for (int c = 0; c < 4; c++)
                assert_int_equal(lrint(raw.pixels[4 * i + c] * (double)top), c == 3 ? 0 : c ? top - i : i);
        image_destroy(&raw), image_destroy(&colour), image_destroy(&height);
    }
}

static void a_relief_may_say_little(void **state) {
    (void)state;
    Image colour = pattern(3, 2, 3), height = pattern(3, 2, 1);
    const char *names[] = {"little.png", "little.exr"};
    for (int n = 0; n < 2; n++) {
        assert_null(image_write_relief(&colour, &height, in_folder(names[n]), 8));
        Image read = image_load(in_folder(names[n]), IMAGE_HEIGHT);
        assert_true(isnan(read.scale) && isnan(read.base) && isnan(read.basis.a.x) && !read.hollow);
        assert_string_equal(read.basis.unit, "");
        assert_float_equal(read.pixels[1], height.pixels[1], 0.501 / 255);
        image_destroy(&read);
    }
    image_destroy(&colour), image_destroy(&height);
}

static void numbers_are_the_same_in_every_locale(void **state) {
    (void)state;
    const char *comma[] = {"de_DE.UTF-8", "fr_FR.UTF-8", "fi_FI.UTF-8", "de_DE.utf8"};
    for (size_t i = 0; i < sizeof comma / sizeof *comma; i++)
        if (setlocale(LC_ALL, comma[i])) break; /* where the machine has one */
    Image colour = pattern(2, 2, 3), height = relief_height(2, 2);
    assert_null(image_write_relief(&colour, &height, in_folder("l.png"), 8));
    Image read = image_load(in_folder("l.png"), IMAGE_HEIGHT);
    setlocale(LC_ALL, "C");
    assert_basis(&read.basis, &height.basis);
    assert_true(read.scale == 0.1 && read.base == 1 / 3.0);
    file_read(in_folder("l.png"), &scratch);
    assert_non_null(memmem(scratch.bytes, scratch.size, "texel:scale\0000.1", 15));
    image_destroy(&read), image_destroy(&colour), image_destroy(&height);
}

/* A relief of one texel by hand, whose text chunk `name` says `said`; version: what texel:relief says. */
static const char *relief_make(int channels, const char *version, const char *name, const char *said) {
    const char *path = in_folder("hand.png");
    static Bytes chunks, file;
    char text[600];
    int size = snprintf(text, sizeof text, "texel:relief%c%s", 0, version);
    png_make(path, 1, 1, channels, (unsigned char[]){200, 100, 50, 51}, "tEXt", text, (size_t)size);
    size = snprintf(text, sizeof text, "%s%c%s", name, 0, said);
    chunks.size = 0;
    put_chunk(&chunks, "tEXt", text, (size_t)size);
    file_read(path, &file);
    memmove(file.bytes + 33 + chunks.size, file.bytes + 33, file.size - 33); /* after IHDR */
    memcpy(file.bytes + 33, chunks.bytes, chunks.size);
    file_write(path, file.bytes, file.size + chunks.size);
    return path;
}

static void reads_reliefs_made_by_hand(void **state) {
    (void)state;
    const char *path = relief_make(4, "1", "texel:basis", "1 2 3 4 0 0 0 -5 0 0 0 -1e0");
    Image colour = image_load(path, IMAGE_COLOUR), height = image_load(path, IMAGE_HEIGHT);
    assert_true(colour.pixels[2] == (float)srgb_decode(50 / 255.0));
    assert_true(height.pixels[0] == (float)(51 / 255.0));
    const Basis basis = {v3(1, 2, 3), v3(4, 0, 0), v3(0, -5, 0), v3(0, 0, -1), ""};
    assert_basis(&height.basis, &basis);
    image_destroy(&colour), image_destroy(&height);
    height = image_load(relief_make(4, "1", "texel:basis", "  1 2 3   4 0 0 0 1 0 0 0 1"), IMAGE_HEIGHT);
    assert_true(height.basis.origin.x == 1 && height.basis.a.x == 4 && height.basis.f.z == 1);
    image_destroy(&height);
    height = image_load(relief_make(4, "1", "texel:hollow", "0"), IMAGE_HEIGHT);
    assert_false(height.hollow);
    image_destroy(&height);

    const char *basis_only = "texel:basis\0one two"; /* without texel:relief, an RGBA image is none */
    path = in_folder("plain.png");
    png_make(path, 1, 1, 4, (unsigned char[]){200, 100, 50, 51}, "tEXt", basis_only, 19);
    height = image_load(path, IMAGE_HEIGHT);
    assert_true(height.pixels[0] == (float)(200 / 255.0) && isnan(height.basis.a.x) && !height.relief);
    image_destroy(&height);
}

/* Programs that edit pictures often write what they do not know behind the pixels. */
static void reads_texts_behind_the_pixels(void **state) {
    (void)state;
    static Bytes file, ours;
    Image colour = pattern(13, 7, 3), height = relief_height(13, 7);
    const char *path = in_folder("behind.png");
    assert_null(image_write_relief(&colour, &height, path, 16));
    file_read(path, &file);
    memcpy(scratch.bytes, file.bytes, scratch.size = 8);
    ours.size = 0;
    for (size_t at = 8, size; at < file.size; at += size) { /* a chunk after the other */
        const unsigned char *head = file.bytes + at;
        size = 12u + ((size_t)head[0] << 24 | head[1] << 16 | head[2] << 8 | head[3]);
        if (!memcmp(head + 4, "IEND", 4)) put(&scratch, ours.bytes, ours.size);
        put(memcmp(head + 4, "tEXt", 4) ? &scratch : &ours, head, size);
    }
    assert_true(ours.size > 100);
    assert_int_equal(scratch.size, file.size);
    file_write(path, scratch.bytes, scratch.size);
    assert_relief(path, 16, &colour, &height, 0.501 / 65535, 0.501 / 65535);
    image_destroy(&colour), image_destroy(&height);
}

static void refuses_bad_reliefs(void **state) {
    (void)state;
    const struct {
        const char *name, *said;
    } bad[] = {
        {"texel:basis", ""},
        {"texel:basis", "1"},
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0"},     /* eleven numbers */
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 1 7"}, /* thirteen */
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 1,"},  /* something after them */
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 1x"},
        {"texel:basis", "0,0,0,1,0,0,0,1,0,0,0,1"},
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 nan"},
        {"texel:basis", "0 0 inf 1 0 0 0 1 0 0 0 1"},
        {"texel:basis", "0 0 1e999 1 0 0 0 1 0 0 0 1"},
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 one"},
        {"texel:basis", "0 0 0 0 0 0 0 1 0 0 0 1"},         /* a is nothing */
        {"texel:basis", "0 0 0 1 0 0 0 1 0 0 0 0"},         /* f is nothing */
        {"texel:basis", "0 0 0 1 0 0 2 0 0 0 0 1"},         /* a along b */
        {"texel:basis", "0 0 0 1 0 0 0 1 0 3 5 0"},         /* f in their plane */
        {"texel:basis", "0 0 0 1e200 0 0 0 1e200 0 0 0 1"}, /* too large to compute with */
        {"texel:scale", "deep"},
        {"texel:base", "1,5"},
        {"texel:unit", "nautical miles, English ones"},
        {"texel:hollow", "yes"},
        {"texel:hollow", "2"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        const char *path = relief_make(4, "1", bad[i].name, bad[i].said);
        assert_refused(path, IMAGE_HEIGHT, bad[i].name);
        Image image = image_load(path, IMAGE_COLOUR); /* where it does not matter */
        image_destroy(&image);
    }
    char endless[501] = {0}; /* a reason stays short, and one line */
    memset(endless, '1', 500);
    endless[250] = '\n';
    assert_refused(relief_make(4, "1", "texel:basis", endless), IMAGE_HEIGHT, "12 numbers");

    const char *versions[] = {"2", "0", "", "1.0", "-1", "yes"};
    for (size_t i = 0; i < sizeof versions / sizeof *versions; i++) {
        const char *path = relief_make(4, versions[i], "texel:scale", "0.1");
        assert_refused(path, IMAGE_HEIGHT, "texel:relief is \"");
        assert_refused(path, IMAGE_COLOUR, "version 1");
        Image image = image_load(path, IMAGE_RAW); /* as it is stored, whatever it means */
        image_destroy(&image);
    }
    for (int channels = 1; channels <= 3; channels += 2) {
        const char *path = relief_make(channels, "1", "texel:scale", "0.1");
        assert_refused(path, IMAGE_HEIGHT, "four channels");
        assert_refused(path, IMAGE_COLOUR, "four channels");
    }
}

static void refuses_to_write_bad_reliefs(void **state) {
    (void)state;
    folder_count(true);
    Image colour = pattern(4, 3, 3), height = relief_height(4, 3), other = relief_height(3, 4);
    const char *path = in_folder("no.png");
    assert_says(image_write_relief(&colour, &other, path, 8), "the colour is 4 x 3 texels, the height 3 x 4");
    assert_says(image_write_relief(&height, &height, path, 8), "three channels");
    assert_says(image_write_relief(&colour, &colour, path, 8), "three channels");
    assert_says(image_write_relief(&colour, &height, in_folder("no.jpg"), 8), ".png or .exr");
    assert_says(image_write_relief(&colour, &height, in_folder("no/no.png"), 8), "No such file");
    height.basis.f = height.basis.a;
    assert_says(image_write_relief(&colour, &height, path, 8), "volume");
    height.basis = skew();
    height.basis.origin.y = NAN;
    assert_says(image_write_relief(&colour, &height, path, 8), "finite");
    assert_int_equal(folder_count(false), 0);
    image_destroy(&colour), image_destroy(&height), image_destroy(&other);
}

/* ---- Sampling ------------------------------------------------------------------------------------------ */

static double sample(const Image *image, double u, double v) {
    double out[4];
    image_sample(image, u, v, out);
    return out[0];
}

static void samples_between_texels(void **state) {
    (void)state;
    Image image = image_create(4, 2, 1);
    const float texels[] = {1, 2, 4, 8, /* row 0: the bottom */ 16, 32, 64, 128};
    memcpy(image.pixels, texels, sizeof texels);
    for (int y = 0; y < 2; y++)
        for (int x = 0; x < 4; x++)
            assert_true(sample(&image, (x + 0.5) / 4, (y + 0.5) / 2) == texels[4 * y + x]);
    assert_float_equal(sample(&image, 0.25, 0.25), 1.5, 1e-15);
    assert_float_equal(sample(&image, 0.25, 0.5), (1 + 2 + 16 + 32) / 4.0, 1e-13);
    assert_float_equal(sample(&image, 0, 0.25), 4.5, 1e-15); /* between the last column and the first */
    assert_float_equal(sample(&image, 1, 0.25), 4.5, 1e-15);
    assert_float_equal(sample(&image, 0.125, 0), 8.5, 1e-13);
    assert_float_equal(sample(&image, 0.125, 1), 8.5, 1e-13);
    const double far[] = {1, -1, 7, -12, 1024, -4096, 1048576, -1048576}; /* repeated, exactly */
    for (size_t i = 0; i < sizeof far / sizeof *far; i++)
        for (int k = 0; k < 64; k++)
            assert_true(sample(&image, k / 64.0 + far[i], k / 32.0 - far[i]) ==
                        sample(&image, k / 64.0, k / 32.0));
    const double odd[] = {1e300, -1e300, 1e18, -1e-20, 5e-324, 1 - 1e-16, -1 + 1e-16};
    for (size_t i = 0; i < sizeof odd / sizeof *odd; i++)
        for (size_t k = 0; k < sizeof odd / sizeof *odd; k++) {
            double value = sample(&image, odd[i], odd[k]);
            assert_true(value >= 1 && value <= 128);
        }
    image_destroy(&image);

    Image one = image_create(1, 1, 3);
    one.pixels[0] = 0.25f;
    one.pixels[2] = 9;
    double out[3];
    image_sample(&one, -17.3, 1e9, out);
    assert_true(out[0] == 0.25 && out[1] == 0 && out[2] == 9);
    image_destroy(&one);
    assert_null(one.pixels);
}

int main(int argc, char **argv) {
    if (argc == 2) { /* load_ends_the_program, from the inside */
        image_load(argv[1], IMAGE_COLOUR);
        return 0;
    }
    cmocka_set_message_output(CM_OUTPUT_TAP);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(load_ends_the_program),
        cmocka_unit_test(refuses_what_is_no_image),
        cmocka_unit_test(refuses_truncated_files),
        cmocka_unit_test(demands_the_end_of_a_jpeg),
        cmocka_unit_test(refuses_broken_pixels),
        cmocka_unit_test(refuses_sizes),
        cmocka_unit_test(refuses_what_is_not_finite),
        cmocka_unit_test(row_0_is_the_bottom),
        cmocka_unit_test(colour_is_decoded),
        cmocka_unit_test(srgb_is_the_standard),
        cmocka_unit_test(bytes_survive),
        cmocka_unit_test(sixteen_bits_survive),
        cmocka_unit_test(floats_survive),
        cmocka_unit_test(jpeg_and_hdr_come_close),
        cmocka_unit_test(clipped_where_it_must),
        cmocka_unit_test(scale_and_base_survive),
        cmocka_unit_test(refuses_bad_scale_and_base),
        cmocka_unit_test(writes_whole_or_not_at_all),
        cmocka_unit_test(same_image_same_file),
        cmocka_unit_test(reliefs_survive),
        cmocka_unit_test(reliefs_are_read_and_written_alike),
        cmocka_unit_test(colour_survives_where_height_is_0),
        cmocka_unit_test(a_relief_may_say_little),
        cmocka_unit_test(numbers_are_the_same_in_every_locale),
        cmocka_unit_test(reads_reliefs_made_by_hand),
        cmocka_unit_test(reads_texts_behind_the_pixels),
        cmocka_unit_test(refuses_bad_reliefs),
        cmocka_unit_test(refuses_to_write_bad_reliefs),
        cmocka_unit_test(samples_between_texels),
    };
    return cmocka_run_group_tests_name("image", tests, folder_make, folder_remove);
}
