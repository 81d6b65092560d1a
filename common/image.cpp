/* Image files by OpenImageIO. The only C++ in common: it stays behind the C interface of image.h, in a
 * library of its own (see image_files.h). */
#define _Noreturn [[noreturn]] /* C++ has no word for it that fail.h could share */
extern "C" {
#include "image_files.h"
#include "fail.h"
}

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <memory>
#include <mutex>
#include <string>
#include <sys/stat.h>
#include <unistd.h>
#include <vector>

/* ---- Reading --------------------------------------------------------------------------------------- */

/* While one of these lives, nothing reaches standard error: libpng prints a line of its own there, and a
 * program should say one line, ours. One at a time, for the whole process has but one standard error. */
class Silence {
    static std::mutex one;
    std::lock_guard<std::mutex> lock{one};
    int saved = dup(STDERR_FILENO);

  public:
    Silence() {
        int nothing = open("/dev/null", O_WRONLY | O_CLOEXEC);
        if (saved >= 0 && nothing >= 0) dup2(nothing, STDERR_FILENO);
        if (nothing >= 0) close(nothing);
    }
    ~Silence() {
        if (saved < 0) return;
        dup2(saved, STDERR_FILENO);
        close(saved);
    }
    Silence(const Silence &) = delete;
};
std::mutex Silence::one;

using File = std::unique_ptr<FILE, int (*)(FILE *)>;

/* What a file says in text: names and values. */
using Texts = std::vector<std::pair<std::string, std::string>>;

/* Adds a PNG's text chunk, name, zero, value, to texts if it is one of ours. The file is left anywhere. */
static void png_take_text(FILE *file, long length, Texts *texts) {
    static const char ours[] = "texel:";
    std::string text(length < 4096 ? length : 0, 0);
    if (text.empty() || fread(text.data(), text.size(), 1, file) != 1) return;
    size_t zero = text.find('\0');
    if (zero == std::string::npos || text.compare(0, strlen(ours), ours) != 0) return;
    texts->emplace_back(text.substr(0, zero), text.substr(zero + 1));
}

/* A PNG is a row of chunks: length, name, data, checksum. The last is named IEND. On the way there our texts
 * are taken along: OpenImageIO sees those before the pixels, but many a program writes them behind. */
static bool png_has_end(FILE *file, Texts *texts) {
    unsigned char head[8], checksum[4];
    if (fseek(file, 8, SEEK_SET)) return false;
    while (fread(head, sizeof head, 1, file) == 1) {
        if (memcmp(head + 4, "IEND", 4) == 0) return fread(checksum, sizeof checksum, 1, file) == 1;
        long length = (long)head[0] << 24 | head[1] << 16 | head[2] << 8 | head[3], data = ftell(file);
        if (memcmp(head + 4, "tEXt", 4) == 0) png_take_text(file, length, texts);
        if (fseek(file, data + length + 4, SEEK_SET)) return false;
    }
    return false;
}

/* A JPEG is a row of segments, each a marker FF xx, a length and data; the coded image, which follows a
 * segment of its own, holds no marker but stuffed zeros and restarts. The last marker is FF D9. Following
 * the segments keeps us from taking a thumbnail's end for the image's, or from minding what comes after. */
static bool jpeg_has_end(FILE *file) {
    if (fseek(file, 2, SEEK_SET)) return false;
    for (;;) {
        int c = getc_unlocked(file);
        while (c != 0xff && c != EOF) c = getc_unlocked(file);
        while (c == 0xff) c = getc_unlocked(file);
        if (c == EOF) return false;
        if (c == 0xd9) return true;
        if (c == 0 || c == 1 || (c >= 0xd0 && c <= 0xd8)) continue; /* these have no length */
        int high = getc_unlocked(file), low = getc_unlocked(file);
        if (low == EOF || fseek(file, (high << 8 | low) - 2, SEEK_CUR)) return false;
    }
}

/* What can be said of a file before its pixels are decoded: NULL, or the reason why it is refused. Decoders
 * make up what a truncated PNG or JPEG lacks, so the end is looked for here. texts: as png_has_end finds
 * them.
 */
static const char *check_whole(FILE *file, Texts *texts) {
    unsigned char start[8] = {};
    if (fread(start, 1, sizeof start, file) == 0) return "the file is empty";
    bool png = memcmp(start, "\x89PNG\r\n\x1a\n", 8) == 0, jpeg = memcmp(start, "\xff\xd8\xff", 3) == 0;
    if (png && !png_has_end(file, texts)) return "the file is truncated: a PNG ends with an IEND chunk";
    if (jpeg && !jpeg_has_end(file)) return "the file is truncated: a JPEG ends with an end marker";
    return nullptr;
}

static const char *check_size(const OIIO::ImageSpec &spec, int channels) {
    if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
        return because("the image has no pixels: %dx%d", spec.width, spec.height);
    if (spec.width > IMAGE_SIDE_MAX || spec.height > IMAGE_SIDE_MAX)
        return because("the image is too large: %dx%d pixels, at most %d a side", spec.width, spec.height,
                       IMAGE_SIDE_MAX);
    if (spec.depth > 1) return because("the image is a volume, %d pixels deep", spec.depth);
    if (channels > 4) return because("the image has %d channels, at most 4 are read", channels);
    if ((int64_t)spec.width * spec.height * channels * (int64_t)sizeof(float) > (int64_t)1 << 30)
        return because("the image is too large: %dx%d pixels of %d channels, more than 1 GiB as floats",
                       spec.width, spec.height, channels);
    return nullptr;
}

/* What a file says under a name, "" when it says nothing. A reason is one line, so no other character is kept
 * that could end it. */
static std::string read_text(const OIIO::ImageSpec &spec, const char *name) {
    const OIIO::ParamValue *attribute = spec.find_attribute(name);
    std::string text = attribute ? attribute->get_string() : "";
    for (char &c : text)
        if ((unsigned char)c < ' ') c = '?';
    return text;
}

/* Takes a number, finite, from the start of a text: unlike strtod, in every locale. */
static bool take_number(const char **text, const char *end, double *number) {
    auto [stop, error] = std::from_chars(*text, end, *number);
    *text = stop;
    return error == std::errc() && std::isfinite(*number);
}

/* A number that the file keeps as text, NAN when it keeps none. */
static const char *read_number(const OIIO::ImageSpec &spec, const char *name, double *number) {
    *number = NAN;
    if (!spec.find_attribute(name)) return nullptr;
    std::string text = read_text(spec, name);
    const char *at = text.data(), *end = at + text.size();
    if (take_number(&at, end, number) && at == end) return nullptr;
    return because("its %s is no number: \"%.40s\"", name, text.c_str());
}

/* A relief's a, b and f span a volume: none is zero, nor in the plane of the other two. */
static bool spans_volume(const Basis &basis) {
    double volume = vec3_dot(vec3_cross(basis.a, basis.b), basis.f);
    return fabs(volume) > 1e-9 * vec3_length(basis.a) * vec3_length(basis.b) * vec3_length(basis.f);
}

static const char *read_basis(const OIIO::ImageSpec &spec, Basis *basis) {
    if (!spec.find_attribute("texel:basis")) return nullptr;
    std::string text = read_text(spec, "texel:basis");
    const char *at = text.data(), *end = at + text.size();
    double numbers[12];
    bool good = true;
    for (int i = 0; i < 12 && good; i++) {
        const char *before = at;
        while (at < end && *at == ' ') at++;
        good = (i == 0 || at > before) && take_number(&at, end, &numbers[i]);
    }
    if (!good || at != end) return because("its texel:basis is not 12 numbers: \"%.80s\"", text.c_str());
    auto vector = [&](int i) { return v3(numbers[i], numbers[i + 1], numbers[i + 2]); };
    basis->origin = vector(0), basis->a = vector(3), basis->b = vector(6), basis->f = vector(9);
    if (!spans_volume(*basis)) return "its texel:basis spans no volume";
    return nullptr;
}

/* A file is a relief texture when it says so; then it has a version that we know, and four channels. */
static const char *read_is_relief(const OIIO::ImageSpec &spec, bool *relief) {
    *relief = spec.find_attribute("texel:relief") != nullptr;
    if (!*relief) return nullptr;
    std::string version = read_text(spec, "texel:relief");
    if (version != "1")
        return because("its texel:relief is \"%.40s\": version 1 is the one that is read", version.c_str());
    if (spec.nchannels != 4)
        return because("a relief texture has four channels, but this file has %d", spec.nchannels);
    return nullptr;
}

/* What a height map's file says about it goes into image; of basis, unit and hollow a relief texture's alone.
 */
static const char *read_about_height(const OIIO::ImageSpec &spec, bool relief, Image *image) {
    const char *refused = read_number(spec, "texel:scale", &image->scale);
    if (!refused) refused = read_number(spec, "texel:base", &image->base);
    if (refused || !relief) return refused;
    refused = read_basis(spec, &image->basis);
    if (refused) return refused;
    std::string unit = read_text(spec, "texel:unit"), hollow = read_text(spec, "texel:hollow");
    if (unit.size() >= sizeof image->basis.unit)
        return because("its texel:unit is longer than %zu bytes: \"%.40s\"", sizeof image->basis.unit - 1,
                       unit.c_str());
    if (hollow != "" && hollow != "0" && hollow != "1")
        return because("its texel:hollow is neither 0 nor 1: \"%.40s\"", hollow.c_str());
    strcpy(image->basis.unit, unit.c_str());
    image->hollow = hollow == "1";
    return nullptr;
}

/* Whether a file's numbers are sRGB. It may say so; if not, integers are and floats are not. */
static bool is_srgb(const OIIO::ImageSpec &spec) {
    std::string space = spec.get_string_attribute("oiio:ColorSpace");
    if (space.empty()) return !spec.format.is_floating_point();
    return strncasecmp(space.c_str(), "lin", 3) != 0 && strcasecmp(space.c_str(), "scene_linear") != 0;
}

/* Every number that an integer of the file can become, so that decoding is exact and quick. */
static std::vector<float> integer_table(int count, bool srgb) {
    std::vector<float> table(count);
    for (int i = 0; i < count; i++) {
        double stored = (double)i / (count - 1);
        table[i] = (float)(srgb ? srgb_decode(stored) : stored);
    }
    return table;
}

/* Reads `channels` channels from `first` on as floats, the top row first. */
static bool read_floats(OIIO::ImageInput &input, int first, int channels, bool srgb, float *out) {
    const OIIO::ImageSpec &spec = input.spec();
    int end = first + channels;
    size_t count = (size_t)spec.width * spec.height * channels;
    if (spec.format == OIIO::TypeDesc::UINT8) {
        std::vector<uint8_t> codes(count);
        if (!input.read_image(0, 0, first, end, spec.format, codes.data())) return false;
        std::vector<float> table = integer_table(1 << 8, srgb);
        for (size_t i = 0; i < count; i++) out[i] = table[codes[i]];
    } else if (spec.format == OIIO::TypeDesc::UINT16) {
        std::vector<uint16_t> codes(count);
        if (!input.read_image(0, 0, first, end, spec.format, codes.data())) return false;
        std::vector<float> table = integer_table(1 << 16, srgb);
        for (size_t i = 0; i < count; i++) out[i] = table[codes[i]];
    } else {
        if (!input.read_image(0, 0, first, end, OIIO::TypeDesc::FLOAT, out)) return false;
        if (srgb)
            for (size_t i = 0; i < count; i++) out[i] = (float)srgb_decode(out[i]);
    }
    return true;
}

/* The body of image_read: may throw what OpenImageIO and its libraries throw. */
static const char *read_or_throw(Image *image, const char *path, ImageKind kind) {
    struct stat about;
    if (stat(path, &about)) return strerror(errno);
    if (S_ISDIR(about.st_mode)) return strerror(EISDIR);
    if (!S_ISREG(about.st_mode)) return "not a regular file";
    File file(fopen(path, "rb"), fclose);
    if (!file) return strerror(errno);
    Texts texts;
    const char *refused = check_whole(file.get(), &texts);
    if (refused) return refused;

    OIIO::ImageSpec wish;
    wish["oiio:UnassociatedAlpha"] = 1; /* colours as they are stored, not multiplied by alpha */
    std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(path, &wish);
    if (!input) {
        OIIO::geterror(); /* fetched, or OpenImageIO prints it at the end of the program */
        return "not an image, or a broken one";
    }
    OIIO::ImageSpec spec = input->spec();
    for (const auto &[name, text] : texts) spec[name] = text;
    int channels = kind == IMAGE_RAW ? spec.nchannels : kind == IMAGE_HEIGHT ? 1 : spec.nchannels < 3 ? 1 : 3;
    refused = check_size(spec, channels);
    bool relief = false;
    if (kind != IMAGE_RAW && !refused) refused = read_is_relief(spec, &relief);
    Image said = {};
    said.scale = said.base = said.basis.a.x = NAN;
    if (kind == IMAGE_HEIGHT && !refused) refused = read_about_height(spec, relief, &said);
    if (refused) return refused;
    int first = kind == IMAGE_HEIGHT && relief ? 3 : 0;

    std::vector<float> stored((size_t)spec.width * spec.height * channels);
    if (!read_floats(*input, first, channels, kind == IMAGE_COLOUR && is_srgb(spec), stored.data())) {
        input->geterror();
        return "the file is truncated or broken: not all of its pixels can be read";
    }
    for (size_t i = 0; i < stored.size(); i++)
        if (!std::isfinite(stored[i]))
            return because("not finite at column %zu, row %zu", i / channels % spec.width,
                           i / channels / spec.width);

    Image result = image_create(spec.width, spec.height, kind == IMAGE_COLOUR ? 3 : channels);
    size_t bytes = spec.format.is_floating_point() ? 4 : spec.format.size();
    result.bits = bytes == 1 ? 8 : bytes == 2 ? 16 : 32;
    result.scale = said.scale;
    result.base = said.base;
    result.basis = said.basis;
    result.hollow = said.hollow;
    result.relief = relief;
    for (int y = 0; y < spec.height; y++) { /* the file's first row is the top one, ours the bottom one */
        const float *from = &stored[(size_t)(spec.height - 1 - y) * spec.width * channels];
        float *to = image_at(&result, 0, y);
        if (result.channels == channels)
            memcpy(to, from, (size_t)spec.width * channels * sizeof(float));
        else
            for (int x = 0; x < spec.width; x++) to[3 * x] = to[3 * x + 1] = to[3 * x + 2] = from[x];
    }
    *image = result;
    return nullptr;
}

static const char *read(Image *image, const char *path, ImageKind kind) {
    try {
        Silence silence;
        return read_or_throw(image, path, kind);
    } catch (const std::exception &exception) {
        return because("cannot be read: %s", exception.what());
    }
}

/* ---- Writing --------------------------------------------------------------------------------------- */

/* Creates a file of an unused hidden name in the folder of path, and says that name. */
static File create_beside(const char *path, std::string *name) {
    const char *slash = strrchr(path, '/');
    std::string folder = slash ? std::string(path, slash + 1) : "";
    for (int i = 0;; i++) {
        *name = folder + ".texel-" + std::to_string(getpid()) + "-" + std::to_string(i);
        FILE *file = fopen(name->c_str(), "wbx"); /* x: fails if it exists */
        if (file || errno != EEXIST) return File(file, fclose);
    }
}

/* Makes the file appear whole or not at all: written under another name, then renamed. */
static const char *store(const std::vector<unsigned char> &bytes, const char *path) {
    struct stat there; /* renaming onto a device would replace it */
    if (stat(path, &there) == 0 && !S_ISREG(there.st_mode))
        return S_ISDIR(there.st_mode) ? "cannot be written: Is a directory" : "cannot be written: is no file";
    std::string name;
    File file = create_beside(path, &name);
    if (!file) return because("cannot be written: %s", strerror(errno));
    bool written = fwrite(bytes.data(), 1, bytes.size(), file.get()) == bytes.size();
    int error = errno; /* of the first call that failed */
    if (fclose(file.release()) && written) written = false, error = errno;
    if (written && rename(name.c_str(), path)) written = false, error = errno;
    if (written) return nullptr;
    unlink(name.c_str());
    return because("cannot be written: %s", strerror(error));
}

/* Encodes pixels, the top row first, in the format of path's ending, in memory: so every failure of the disk
 * is ours to see. Nothing goes in that differs from run to run. */
static const char *encode(const char *path, const OIIO::ImageSpec &spec, const void *pixels) {
    std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(path);
    if (!output || !output->supports("ioproxy")) {
        OIIO::geterror();
        return "cannot be written: no image format has this ending";
    }
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    output->set_ioproxy(&memory);
    bool encoded = output->open(path, spec) && output->write_image(spec.format, pixels);
    encoded &= output->close();
    if (!encoded) {
        output->geterror();
        return "cannot be written: the image does not fit this format";
    }
    return store(bytes, path);
}

static bool has_ending(const char *path, const char *ending) {
    size_t length = strlen(path), tail = strlen(ending);
    return length > tail && strcasecmp(path + length - tail, ending) == 0;
}

/* One row after the other, the top one first, each number through `convert`; of each pixel the first
 * `channels` (more than the image has: its grey repeated). */
template <typename Number, typename Convert>
static std::vector<Number> converted(const Image *image, int channels, Convert convert) {
    std::vector<Number> result;
    result.reserve((size_t)image->width * image->height * channels);
    for (int y = image->height - 1; y >= 0; y--)
        for (int x = 0; x < image->width; x++) {
            const float *pixel = image_at(image, x, y);
            for (int c = 0; c < channels; c++)
                result.push_back(convert(pixel[channels > image->channels ? 0 : c]));
        }
    return result;
}

/* What one number becomes in a file. */
static float unit(float x) { return x > 0 ? x < 1 ? x : 1 : 0; } /* NaN becomes 0 */
static float same(float x) { return x; }
static uint8_t raw_byte(float x) { return (uint8_t)(unit(x) * 255.0 + 0.5); }
static uint16_t raw_sixteen(float x) { return (uint16_t)(unit(x) * 65535.0 + 0.5); }
static uint16_t srgb_sixteen(float x) { return (uint16_t)(srgb_encode(unit(x)) * 65535.0 + 0.5); }

static OIIO::ImageSpec spec_of(const Image *image, int channels, OIIO::TypeDesc type) {
    OIIO::ImageSpec spec(image->width, image->height, channels, type);
    spec["compression"] = "none"; /* of EXR: floats hardly shrink, and it costs five times the time */
    spec["png:compressionLevel"] = 1;
    spec["oiio:UnassociatedAlpha"] = 1;
    if (type == OIIO::TypeDesc::FLOAT) spec["DateTime"] = "1970:01:01 00:00:00"; /* else EXR has today's */
    return spec;
}

static const char *write_floats(const Image *image, const char *path, int channels, OIIO::ImageSpec spec) {
    return encode(path, spec, converted<float>(image, channels, same).data());
}

/* The shortest text that reads back as the same double. */
static std::string number_text(double number) {
    char text[32];
    return std::string(text, std::to_chars(text, text + sizeof text, number).ptr);
}

static void say_scale_and_base(const Image *height, OIIO::ImageSpec *spec) {
    if (!std::isnan(height->scale)) (*spec)["texel:scale"] = number_text(height->scale);
    if (!std::isnan(height->base)) (*spec)["texel:base"] = number_text(height->base);
}

/* Runs a body that may throw, with nothing printed by libraries. */
template <typename Body> static const char *guarded(Body body) {
    try {
        Silence silence;
        return body();
    } catch (const std::exception &exception) {
        return because("cannot be written: %s", exception.what());
    }
}

static const char *write(const Image *image, const char *path) {
    return guarded([&]() -> const char * {
        if (has_ending(path, ".exr"))
            return write_floats(image, path, image->channels,
                                spec_of(image, image->channels, OIIO::TypeDesc::FLOAT));
        if (has_ending(path, ".hdr"))
            return write_floats(image, path, 3, spec_of(image, 3, OIIO::TypeDesc::FLOAT));
        int channels = image->channels < 3 ? 1 : 3;
        OIIO::ImageSpec spec = spec_of(image, channels, OIIO::TypeDesc::UINT8);
        spec["oiio:ColorSpace"] = "sRGB";
        if (has_ending(path, ".jpg") || has_ending(path, ".jpeg")) spec["compression"] = "jpeg:95";
        return encode(path, spec, converted<uint8_t>(image, channels, srgb_byte).data());
    });
}

/* The type of raw numbers in a file; `bits` counts where the ending leaves a choice. */
static OIIO::TypeDesc raw_type(const char *path, int bits) {
    return has_ending(path, ".exr") ? OIIO::TypeDesc::FLOAT
           : bits == 16             ? OIIO::TypeDesc::UINT16
                                    : OIIO::TypeDesc::UINT8;
}

static const char *write_raw(const Image *image, const char *path, int bits) {
    return guarded([&]() -> const char * {
        OIIO::TypeDesc type = raw_type(path, bits);
        if (type != OIIO::TypeDesc::FLOAT && !has_ending(path, ".png"))
            return "cannot be written: raw numbers are kept as .png or .exr";
        OIIO::ImageSpec spec = spec_of(image, image->channels, type);
        say_scale_and_base(image, &spec);
        if (type == OIIO::TypeDesc::FLOAT) return write_floats(image, path, image->channels, spec);
        if (type == OIIO::TypeDesc::UINT16)
            return encode(path, spec, converted<uint16_t>(image, image->channels, raw_sixteen).data());
        return encode(path, spec, converted<uint8_t>(image, image->channels, raw_byte).data());
    });
}

/* ---- Relief textures ---- */

/* What the file says of the height of a relief texture. */
static void say_relief(const Image *height, OIIO::ImageSpec *spec) {
    (*spec)["texel:relief"] = "1";
    say_scale_and_base(height, spec);
    const Basis &basis = height->basis;
    if (!std::isnan(basis.a.x)) {
        std::string numbers;
        for (Vec3 v : {basis.origin, basis.a, basis.b, basis.f})
            for (double x : {v.x, v.y, v.z}) numbers += (numbers.empty() ? "" : " ") + number_text(x);
        (*spec)["texel:basis"] = numbers;
    }
    if (basis.unit[0]) (*spec)["texel:unit"] = basis.unit;
    if (height->hollow) (*spec)["texel:hollow"] = "1";
}

/* Colour and height side by side, rows as in `converted`; each has its own way to become a number. */
template <typename Number, typename Encode, typename Keep>
static std::vector<Number> interleaved(const Image *colour, const Image *height, Encode encode_colour,
                                       Keep keep_height) {
    std::vector<Number> colours = converted<Number>(colour, 3, encode_colour);
    std::vector<Number> heights = converted<Number>(height, 1, keep_height), result;
    result.reserve(4 * heights.size());
    for (size_t i = 0; i < heights.size(); i++) {
        result.insert(result.end(), &colours[3 * i], &colours[3 * i] + 3);
        result.push_back(heights[i]);
    }
    return result;
}

static const char *check_relief(const Image *colour, const Image *height, const char *path,
                                OIIO::TypeDesc type) {
    if (type != OIIO::TypeDesc::FLOAT && !has_ending(path, ".png"))
        return "cannot be written: relief textures are kept as .png or .exr";
    if (colour->channels != 3 || height->channels != 1)
        return "cannot be written: a relief texture is three channels of colour and one of height";
    if (colour->width != height->width || colour->height != height->height)
        return because("cannot be written: the colour is %d x %d texels, the height %d x %d", colour->width,
                       colour->height, height->width, height->height);
    const Basis &basis = height->basis;
    if (std::isnan(basis.a.x)) return nullptr;
    if (!std::isfinite(basis.origin.x + basis.origin.y + basis.origin.z))
        return "cannot be written: its basis is not finite";
    if (!spans_volume(basis)) return "cannot be written: its basis spans no volume";
    return nullptr;
}

static const char *write_relief(const Image *colour, const Image *height, const char *path, int bits) {
    return guarded([&]() -> const char * {
        OIIO::TypeDesc type = raw_type(path, bits);
        const char *refused = check_relief(colour, height, path, type);
        if (refused) return refused;
        OIIO::ImageSpec spec = spec_of(colour, 4, type);
        say_relief(height, &spec);
        if (type == OIIO::TypeDesc::FLOAT) { /* named, or it would be taken for alpha by whoever reads it */
            spec.channelnames = {"R", "G", "B", "height"};
            spec.alpha_channel = -1;
            return encode(path, spec, interleaved<float>(colour, height, same, unit).data());
        }
        spec["oiio:ColorSpace"] = "sRGB";
        if (type == OIIO::TypeDesc::UINT16)
            return encode(path, spec,
                          interleaved<uint16_t>(colour, height, srgb_sixteen, raw_sixteen).data());
        return encode(path, spec, interleaved<uint8_t>(colour, height, srgb_byte, raw_byte).data());
    });
}

/* What image.c asks this library for. */
const ImageFiles image_files = {read, write, write_raw, write_relief};
