#include <gtest/gtest.h>

#include <CLI/CLI.hpp>

#include "haptic_server/cases/casework/case_request.h"

namespace bonemill {
namespace {

CaseRequest everything() {
    CaseRequest request;
    request.scan = "/scans/one of them";
    request.out = "out/case";
    request.series = "1.2.840.1";
    request.acquisition = "2: sharp";
    request.spacing_mm = {0.1, 0.1, 0.25};
    request.title = "It's a tooth";
    request.task = "Mill it away";
    request.credit = "A. N. Other, CC BY 4.0";
    request.figures = "out/figures";
    request.iso = -312.5;
    request.at_mm = {-3.1, 0, 1e-3};
    request.size_mm = 17;
    request.voxel_mm = 0.125;
    request.from_mm = {1, -2.5, 300};
    request.drop_pieces = {2, 5};
    request.labels = "labels.nii.gz";
    request.label_words = {"1=facial nerve:protected", "sinus"};
    request.tools = "deploy/tools/dental.textproto";
    return request;
}

TEST(CaseOptions, ReadBackWhatTheyWrite) {
    const CaseRequest wanted = everything();
    CLI::App app;
    CaseRequest read;
    addCaseOptions(app, read);
    std::vector<std::string> words = wordsOf(wanted);
    std::ranges::reverse(words);  // as CLI11 takes them
    app.parse(words);
    EXPECT_EQ(read.scan, wanted.scan);
    EXPECT_EQ(read.out, wanted.out);
    EXPECT_EQ(read.series, wanted.series);
    EXPECT_EQ(read.acquisition, wanted.acquisition);
    EXPECT_EQ(read.spacing_mm, wanted.spacing_mm);
    EXPECT_EQ(read.title, wanted.title);
    EXPECT_EQ(read.task, wanted.task);
    EXPECT_EQ(read.credit, wanted.credit);
    EXPECT_EQ(read.figures, wanted.figures);
    EXPECT_EQ(read.iso, wanted.iso);
    EXPECT_EQ(read.at_mm, wanted.at_mm);
    EXPECT_EQ(read.size_mm, wanted.size_mm);
    EXPECT_EQ(read.voxel_mm, wanted.voxel_mm);
    EXPECT_EQ(read.from_mm, wanted.from_mm);
    EXPECT_EQ(read.drop_pieces, wanted.drop_pieces);
    EXPECT_EQ(read.labels, wanted.labels);
    EXPECT_EQ(read.label_words, wanted.label_words);
    EXPECT_EQ(read.tools, wanted.tools);
}

TEST(CaseOptions, AreOneLineForAShell) {
    CaseRequest request;
    request.scan = "a b";
    request.out = "c";
    request.title = "It's";
    EXPECT_EQ(commandLineOf("deploy/make-case", request),
              "deploy/make-case 'a b' --out c --title 'It'\\''s'");
}

}  // namespace
}  // namespace bonemill
