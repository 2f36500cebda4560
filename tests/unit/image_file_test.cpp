#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <pellucid/base/error.h>
#include <pellucid/io/image_file.h>
#include <pellucid/io/plain_file.h>

#include "../support/files.h"

namespace pellucid {
namespace {

namespace fs = std::filesystem;

class ImageFile : public testing::Test {
protected:
    [[nodiscard]] std::string bytes(const char* name) const { return test::bytesOf(folder / name); }
    void write(const char* name, std::string_view text) const {
        std::ofstream(folder / name, std::ios::binary) << text;
    }
    [[nodiscard]] std::ptrdiff_t files() const {
        return std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator());
    }
    [[nodiscard]] std::shared_ptr<const TextureImage> decode(const std::string& text) const {
        return decodeTexture(std::as_bytes(std::span(text)), "here");
    }
    test::TemporaryFolder folder;
};

Image ramp(int width, int height, std::vector<std::string> names) {
    Image image(width, height, std::move(names));
    for (std::size_t i = 0; i < image.data().size(); ++i) image.data()[i] = static_cast<float>(i) * 0.37F - 1.0F;
    return image;
}

void expectKind(ErrorKind kind, const auto& act) {
    try {
        act();
        ADD_FAILURE() << "no error";
    } catch (const Error& e) {
        EXPECT_EQ(e.kind(), kind) << e.what();
    }
}

TEST_F(ImageFile, ExrKeepsEveryChannelBitForBit) {
    Image image = ramp(7, 5, {"R", "G", "B", "albedo.R", "normal.X", "depth.Z", "records.Y", "variance.R"});
    image.data()[3] = 1e30F;
    image.data()[4] = std::numeric_limits<float>::denorm_min();
    writeExr(folder / "a.exr", image, {{"pellucid.version", "1.2.3"}, {"pellucid.note", "a \"b\" ü"}});
    const Image back = readImage(folder / "a.exr");
    ASSERT_EQ(back.width(), 7);
    ASSERT_EQ(back.height(), 5);
    ASSERT_EQ(back.channels(), image.channels());
    for (int c = 0; c < image.channels(); ++c) {
        const int other = back.channel(image.channelNames()[static_cast<std::size_t>(c)]);
        ASSERT_GE(other, 0) << image.channelNames()[static_cast<std::size_t>(c)];
        for (std::size_t p = 0; p < image.pixels(); ++p) EXPECT_EQ(image.at(p, c), back.at(p, other));
    }
    EXPECT_NE(bytes("a.exr").find("pellucid.version"), std::string::npos);
    EXPECT_NE(bytes("a.exr").find("a \"b\" ü"), std::string::npos);
    EXPECT_EQ(files(), 1) << "no temporary file is left";
}

TEST_F(ImageFile, TheSameImageGivesTheSameBytes) {
    const Image image = ramp(16, 16, {"R", "G", "B"});
    writeExr(folder / "a.exr", image, {{"k", "v"}});
    writeExr(folder / "b.exr", image, {{"k", "v"}});
    EXPECT_EQ(bytes("a.exr"), bytes("b.exr"));
}

TEST_F(ImageFile, FailedWritesLeaveNothing) {
    const Image image = ramp(2, 2, {"R", "G", "B"});
    fs::create_directories(folder / "x.exr" / "inside");  // the rename must fail
    expectKind(ErrorKind::CannotFinish, [&] { writeExr(folder / "x.exr", image, {}); });
    expectKind(ErrorKind::CannotFinish, [&] { writeExr(folder / "no" / "x.exr", image, {}); });
    expectKind(ErrorKind::CannotFinish, [&] { writePng(folder / "no" / "x.png", image, 0.0F); });
    expectKind(ErrorKind::CannotFinish, [&] { writePng(folder / "x.png", ramp(2, 2, {"Y"}), 0.0F); });
    EXPECT_EQ(files(), 1);
}

TEST_F(ImageFile, PngIsSrgbRoundedAndExposed) {
    Image image(5, 1, {"R", "G", "B"});
    image.setRgb(0, Rgb(srgbToLinear(100.0F / 255.0F)));
    image.setRgb(1, Rgb(0.25F));
    image.setRgb(2, {-1.0F, 7.0F, std::numeric_limits<float>::quiet_NaN()});
    image.setRgb(3, Rgb(std::numeric_limits<float>::infinity()));
    writePng(folder / "a.png", image, 0.0F, {{"Comment", "hello"}});
    writePng(folder / "b.png", image, 2.0F);
    const auto a = decode(bytes("a.png")), b = decode(bytes("b.png"));
    EXPECT_EQ(a->texels8.at(0), glm::u8vec4(100, 100, 100, 255));
    EXPECT_EQ(a->texels8[1].r, std::lround(255.0F * linearToSrgb(0.25F)));
    EXPECT_EQ(a->texels8[2], glm::u8vec4(0, 255, 0, 255));
    EXPECT_EQ(a->texels8[3].r, 255);
    EXPECT_EQ(b->texels8.at(1).r, 255) << "two stops brighter";
    EXPECT_NE(bytes("a.png").find("hello"), std::string::npos);

    const Image back = readImage(folder / "a.png");
    EXPECT_EQ(back.channelNames(), (std::vector<std::string>{"R", "G", "B"}));
    EXPECT_NEAR(back.at(0, 0), srgbToLinear(100.0F / 255.0F), 1e-6F);
}

TEST_F(ImageFile, ReadsPfmAndHdr) {
    Image image(3, 2, {"R", "G", "B"});
    for (std::size_t i = 0; i < image.data().size(); ++i) image.data()[i] = static_cast<float>(i) * 0.5F;
    writePfm(folder / "a.pfm", image);
    writeRadianceHdr(folder / "a.hdr", image);
    const Image pfm = readImage(folder / "a.pfm"), hdr = readImage(folder / "a.hdr");
    EXPECT_EQ(pfm.channelNames(), image.channelNames());
    for (std::size_t i = 0; i < image.data().size(); ++i) {
        EXPECT_EQ(pfm.data().at(i), image.data()[i]);
        EXPECT_NEAR(hdr.data().at(i), image.data()[i], 0.04F);
    }
}

TEST_F(ImageFile, ReadErrorsNameTheFile) {
    write("broken.exr", "this is no image");
    write("broken.png", std::string("\x89PNG\r\n\x1a\n", 8) + "rubbish");
    for (const char* name : {"broken.exr", "broken.png", "missing.exr", "."})
        expectKind(ErrorKind::BadInput, [&] { (void)readImage(folder / name); });
    writeExr(folder / "a.exr", ramp(64, 64, {"R", "G", "B"}), {});
    fs::resize_file(folder / "a.exr", fs::file_size(folder / "a.exr") / 2);
    expectKind(ErrorKind::BadInput, [&] { (void)readImage(folder / "a.exr"); });
}

/// OpenEXR itself must refuse a header that claims 16 million columns: it would set up its buffers before we see the size.
TEST_F(ImageFile, ExrHeadersAreRefusedBeforeBuffersAreSetUp) {
    writeExr(folder / "a.exr", ramp(8, 4, {"R", "G", "B"}), {});
    std::string text = bytes("a.exr");
    const std::string name("dataWindow\0box2i\0", 17);
    const std::size_t window = text.find(name) + name.size() + 4;
    ASSERT_LT(window + 16, text.size());
    const std::int32_t right = 16'000'000;
    std::memcpy(text.data() + window + 8, &right, sizeof right);
    write("wide.exr", text);
    for (const auto& read :
         std::vector<std::function<void()>>{[&] { (void)readImage(folder / "wide.exr"); }, [&] { (void)decode(text); }})
        try {
            read();
            ADD_FAILURE() << "no error";
        } catch (const Error& e) {
            EXPECT_EQ(e.kind(), ErrorKind::BadInput);
            EXPECT_NE(std::string(e.what()).find("data window"), std::string::npos) << e.what();
        }
}

TEST_F(ImageFile, CheckWritable) {
    EXPECT_NO_THROW(checkWritable(folder / "new.exr"));
    EXPECT_NO_THROW(checkWritable(folder / "new.PNG"));
    expectKind(ErrorKind::CannotFinish, [&] { checkWritable(folder / "new.xyz"); });
    expectKind(ErrorKind::CannotFinish, [&] { checkWritable(folder / "new"); });
    expectKind(ErrorKind::CannotFinish, [&] { checkWritable(folder / "no" / "new.exr"); });
    fs::create_directories(folder / "dir.exr");
    expectKind(ErrorKind::CannotFinish, [&] { checkWritable(folder / "dir.exr"); });
    EXPECT_EQ(files(), 1);
}

/// Uncompressed BMP headers are short enough to write by hand: `width` x `height`, 24 bits.
std::string bmpHeader(std::uint32_t width, std::uint32_t height) {
    std::string text = "BM";
    const auto word = [&text](std::uint32_t v, int size = 4) {
        for (int i = 0; i < size; ++i) text.push_back(static_cast<char>((v >> (8 * i)) & 255U));
    };
    word(54 + 12);
    word(0);
    word(54);
    word(40);
    word(width);
    word(height);
    word(1, 2);
    word(24, 2);
    for (int i = 0; i < 6; ++i) word(0);
    return text;
}

TEST_F(ImageFile, TexturesAreCheckedBeforeMemoryIsAskedFor) {
    expectKind(ErrorKind::BadInput, [&] { (void)decode(""); });
    expectKind(ErrorKind::BadInput, [&] { (void)decode("GIF89a..."); });
    expectKind(ErrorKind::BadInput, [&] { (void)decode(bmpHeader(40000, 1)); });
    expectKind(ErrorKind::BadInput, [&] { (void)decode(bmpHeader(32768, 32768)); });
    const auto image = decode(bmpHeader(1, 1) + std::string("\x10\x20\x30\0", 4));
    EXPECT_EQ(image->texels8.at(0), glm::u8vec4(0x30, 0x20, 0x10, 255));
}

TEST_F(ImageFile, FloatTexturesBecomeSixteenBits) {
    Image image(1, 1, {"R", "G", "B"});
    image.setRgb(0, {0.5F, 2.0F, -1.0F});
    writeExr(folder / "a.exr", image, {});
    const auto texture = decode(bytes("a.exr"));
    EXPECT_TRUE(texture->texels8.empty());
    EXPECT_EQ(texture->texels16.at(0), glm::u16vec4(32768, 65535, 0, 65535));
}

/// Portable grey and alpha formats: PNG files of every kind are 70 bytes or so; these four were made once by hand with
/// zlib's stored blocks: grey 2x1 (10, 200), grey + alpha 1x1 (100, 50), RGBA 1x1 (200, 100, 50, 128), palette 2x1.
TEST_F(ImageFile, GreyAlphaAndPalettePng) {
    static const std::string kSignature("\x89PNG\r\n\x1a\n", 8);
    const auto crc = [](const std::string& text) {
        std::uint32_t c = 0xFFFFFFFFU;
        for (const char byte : text) {
            c ^= static_cast<unsigned char>(byte);
            for (int k = 0; k < 8; ++k) c = (c & 1U) != 0 ? 0xEDB88320U ^ (c >> 1U) : c >> 1U;
        }
        return c ^ 0xFFFFFFFFU;
    };
    const auto big = [](std::uint32_t v) {
        return std::string{static_cast<char>(v >> 24U), static_cast<char>(v >> 16U), static_cast<char>(v >> 8U),
                           static_cast<char>(v)};
    };
    const auto chunk = [&](const std::string& type, const std::string& data) {
        return big(static_cast<std::uint32_t>(data.size())) + type + data + big(crc(type + data));
    };
    const auto png = [&](std::uint32_t width, char depth, char colourType, const std::string& row,
                         const std::string& extra = "") {
        const std::string raw = std::string(1, '\0') + row;
        std::uint32_t a = 1, b = 0;
        for (const char byte : raw) {
            a = (a + static_cast<unsigned char>(byte)) % 65521U;
            b = (b + a) % 65521U;
        }
        const char size = static_cast<char>(raw.size());
        const std::string stored = std::string("\x78\x01\x01", 3) + size + '\0' + static_cast<char>(~size) + '\xff' +
                                   raw + big((b << 16U) | a);
        return kSignature + chunk("IHDR", big(width) + big(1) + depth + colourType + std::string(3, '\0')) + extra +
               chunk("IDAT", stored) + chunk("IEND", "");
    };
    EXPECT_EQ(decode(png(2, 8, 0, "\x0a\xc8"))->texels8,
              (std::vector<glm::u8vec4>{{10, 10, 10, 255}, {200, 200, 200, 255}}));
    EXPECT_EQ(decode(png(1, 8, 4, "\x64\x32"))->texels8.at(0), glm::u8vec4(100, 100, 100, 50)) << "not premultiplied";
    EXPECT_EQ(decode(png(1, 8, 6, "\xc8\x64\x32\x80"))->texels8.at(0), glm::u8vec4(200, 100, 50, 128));
    const std::string palette = chunk("PLTE", std::string("\x01\x02\x03\xff\x80\x00", 6));
    EXPECT_EQ(decode(png(2, 8, 3, std::string("\x01\x00", 2), palette))->texels8.at(0), glm::u8vec4(255, 128, 0, 255));
    EXPECT_EQ(decode(png(1, 16, 0, std::string("\x80\x00", 2)))->texels16.size(), 1U);
    EXPECT_EQ(decode(png(8, 1, 0, "\xa0"))->texels8.at(1), glm::u8vec4(0, 0, 0, 255)) << "one bit a pixel";
}

TEST_F(ImageFile, EnvironmentConstants) {
    const EnvironmentDescription d = loadEnvironment("1,0.5, 2e1");
    EXPECT_EQ(d.constant, Rgb(1, 0.5F, 20));
    EXPECT_EQ(d.map.pixels(), 0U);
    EXPECT_NE(d.contentHash, loadEnvironment("1,0.5,21").contentHash);
    for (const char* bad : {"1,2", "1,2,3,4", "1,2,x", "-1,0,0", "nan,0,0", "inf,0,0", "1,,2", "1e99,0,0", ",,"})
        expectKind(ErrorKind::Usage, [&] { (void)loadEnvironment(bad); });
    for (const char* bad : {"", "nofile.hdr", "1"})
        expectKind(ErrorKind::BadInput, [&] { (void)loadEnvironment(bad); });
}

TEST_F(ImageFile, EnvironmentsAreMendedAndMadeRgb) {
    Image image(2, 2, {"R", "G", "B", "A"});
    for (float& v : image.data()) v = 3.0F;
    image.at(0, 1) = -1.0F;
    image.at(1, 2) = std::numeric_limits<float>::infinity();
    image.at(2, 0) = std::numeric_limits<float>::quiet_NaN();
    image.at(3, 3) = std::numeric_limits<float>::quiet_NaN();  // alpha does not count
    writeExr(folder / "a.exr", image, {});
    const EnvironmentDescription d = loadEnvironment((folder / "a.exr").string());
    EXPECT_EQ(d.map.channels(), 3);
    EXPECT_EQ(d.mendedTexels, 3U);
    EXPECT_EQ(d.map.rgb(0), Rgb(0.0F));
    EXPECT_EQ(d.map.rgb(3), Rgb(3.0F));

    Image single(1, 1, {"Y"});
    single.at(0, 0) = 7.0F;
    writeExr(folder / "y.exr", single, {});
    EXPECT_EQ(loadEnvironment((folder / "y.exr").string()).map.rgb(0), Rgb(7.0F));
}

TEST_F(ImageFile, SharedEnvironments) {
    const fs::path shared = fs::path(PELLUCID_SHARED_SCENES) / "envmaps";
    if (!fs::is_directory(shared)) GTEST_SKIP() << "no shared scenes";
    for (const auto& entry : fs::recursive_directory_iterator(shared)) {
        if (entry.path().extension() != ".exr") continue;
        const EnvironmentDescription d = loadEnvironment(entry.path().string());
        EXPECT_GT(d.map.pixels(), 0U) << entry.path();
        EXPECT_EQ(d.map.channels(), 3) << entry.path();
    }
}

}  // namespace
}  // namespace pellucid
