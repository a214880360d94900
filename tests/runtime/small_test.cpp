// Sizes, statuses, the account, the profile.
#include "runtime/drivers/check.hpp"
#include "runtime/opencl/account.hpp"
#include "runtime/opencl/profile.hpp"
#include "runtime/system/hashes.hpp"
#include "runtime/system/size.hpp"
#include "runtime/system/split_mix.hpp"
#include "tests/runtime/scoped.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace clvr {
namespace {

TEST(Size, IsReadAsPeopleWriteIt) {
    EXPECT_EQ(parse_size("1", "x"), 1u);
    EXPECT_EQ(parse_size("1048576", "x"), 1048576u);
    EXPECT_EQ(parse_size("512M", "x"), 512u << 20);
    EXPECT_EQ(parse_size("1.5G", "x"), 3u << 29);
    EXPECT_EQ(parse_size(" 64 KiB ", "x"), 65536u);
    EXPECT_EQ(parse_size("64kb", "x"), 65536u);
    EXPECT_EQ(parse_size("2t", "x"), std::size_t{2} << 40);
}

TEST(Size, NonsenseIsAUsageErrorThatNamesTheOption) {
    for (const char* text : {"", "0", "-1", "0.0001", "12X", "1 2", "0x10", "nan", "inf", "1e9", "9999999999T", "99999999999999999999", "M",
                             ".5G", "1.5.5", "1 2K", "64iB", "64KiBx", "K64"}) {
        try {
            parse_size(text, "--memory");
            ADD_FAILURE() << text;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            EXPECT_EQ(error.where(), "--memory");
        }
    }
}

TEST(Size, FromTheEnvironment) {
    const ScopedVariable unset("CLVR_MAX_ALLOC", std::nullopt);
    EXPECT_FALSE(size_from_environment("CLVR_MAX_ALLOC"));
    const ScopedVariable set("CLVR_MAX_ALLOC", "16K");
    EXPECT_EQ(size_from_environment("CLVR_MAX_ALLOC"), 16384u);
}

TEST(Size, Text) {
    EXPECT_EQ(size_text(17), "17 bytes");
    EXPECT_EQ(size_text(1536), "1.5 KiB");
    EXPECT_EQ(size_text(std::size_t{312} << 20), "312 MiB");
    EXPECT_EQ(size_text((std::size_t{1} << 40) * 5 / 2), "2.5 TiB");
}

TEST(ErrorLine, IsOneLineWhateverAFileSays) {
    EXPECT_EQ(Error(ErrorKind::input, "\"a\nb\x1b[31m\" is \xc3\xbc", "x\ty").line(), "x y: \"a b [31m\" is \xc3\xbc");
    EXPECT_EQ(Error(ErrorKind::usage, "what").line(), "what");
}

TEST(Hashes, OfPieces) {
    EXPECT_EQ(Hash().add("a").add("bc").hex(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(Hash(Hash::Kind::sha512).add("abc").hex().substr(0, 32), "ddaf35a193617abacc417349ae204131");
    EXPECT_EQ(sha256_hex({"a", "bc"}), sha256_hex("1:a2:bc"));
}

TEST(SplitMix, HasThePublishedNumbers) {
    SplitMix64 numbers(0);
    EXPECT_EQ(numbers.next(), 0xe220a8397b1dcdafu);
    EXPECT_EQ(numbers.next(), 0x6e789e6aa1b965f4u);
}

TEST(Check, NamesTheCallAndTheStatus) {
    const Error error = translated(cl::Error(CL_INVALID_KERNEL_ARGS, "clEnqueueNDRangeKernel"), "shade on a device");
    EXPECT_EQ(error.kind(), ErrorKind::device);
    EXPECT_THAT(error.line(), testing::AllOf(testing::HasSubstr("shade on a device"), testing::HasSubstr("clEnqueueNDRangeKernel"),
                                             testing::HasSubstr("CL_INVALID_KERNEL_ARGS (-52)")));
    EXPECT_EQ(status_name(-9999), "status -9999");
}

TEST(Check, LackOfMemoryIsItsOwnKind) {
    for (const cl_int status : {CL_MEM_OBJECT_ALLOCATION_FAILURE, CL_OUT_OF_RESOURCES, CL_OUT_OF_HOST_MEMORY, CL_INVALID_BUFFER_SIZE})
        EXPECT_EQ(translated(cl::Error(status, "clCreateBuffer"), "x").kind(), ErrorKind::device_memory);
}

TEST(Check, TranslatesOnlyOpenClErrors) {
    EXPECT_EQ(cl_check("x", [] { return 7; }), 7);
    EXPECT_THROW(cl_check("x", []() -> int { throw cl::Error(CL_INVALID_VALUE, "clX"); }), Error);
    EXPECT_THROW(cl_check("x", []() -> int { throw std::bad_alloc(); }), std::bad_alloc);
}

TEST(Account, RefusesAboveTheLimitAndRemembersThePeak) {
    Account account;
    EXPECT_TRUE(account.take(60, 100));
    EXPECT_FALSE(account.take(41, 100));
    EXPECT_EQ(account.used(), 60u);
    EXPECT_TRUE(account.take(40, 100));
    EXPECT_FALSE(account.take(1, 50)) << "a limit lowered below the use";
    account.give_back(60);
    EXPECT_EQ(account.used(), 40u);
    EXPECT_EQ(account.peak(), 100u);
    EXPECT_FALSE(account.take(SIZE_MAX, 100)) << "no overflow";
}

TEST(Account, IsSharedByRootAndEndsWithItsLastHolder) {
    const int a = 0, b = 0;
    auto first = account_of(&a);
    EXPECT_EQ(first, account_of(&a));
    EXPECT_NE(first, account_of(&b));
    EXPECT_TRUE(first->take(5, 10));
    first.reset();
    EXPECT_EQ(account_of(&a)->peak(), 0u);
}

TEST(Profile, SumsByLabelInOrderOfFirstUse) {
    Profile profile;
    profile.add("trace", 1, 4e9, 0);
    profile.add("shade", 2, 0, 6e9);
    profile.add("trace", 3, 4e9, 0);
    ASSERT_EQ(profile.rows().size(), 2u);
    EXPECT_EQ(profile.rows()[0].label, "trace");
    EXPECT_EQ(profile.rows()[0].launches, 2u);
    EXPECT_EQ(profile.rows()[0].elapsed_ms, 4);
    EXPECT_EQ(profile.rows()[0].bytes, 8e9);
    EXPECT_EQ(profile.table(), "stage  launches          ms   share      GB/s   GFLOP/s\n"
                               "trace         2        4.00   66.7%    2000.0         -\n"
                               "shade         1        2.00   33.3%         -    3000.0\n"
                               "total                  6.00\n");
    profile.clear();
    EXPECT_TRUE(profile.rows().empty());
}

TEST(Sha256, KnownDigestAndUnambiguousLists) {
    EXPECT_EQ(sha256_hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"); // FIPS 180-2, appendix B.1
    EXPECT_NE(sha256_hex({"ab", "c"}), sha256_hex({"a", "bc"}));
}

} // namespace
} // namespace clvr
