#include "strict_config/text_file.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST_F(ConfigTest, FilesThatCannotBeRead) {
  LoadFile<Scenario>("none.yaml");
  EXPECT_EQ(Errors(), "none.yaml: does not exist");
  fs::create_directory(root / "dir.yaml");
  LoadFile<Scenario>("dir.yaml");
  EXPECT_EQ(Errors(), "dir.yaml: is a folder, not a file");
  ASSERT_EQ(mkfifo((root / "pipe.yaml").c_str(), 0600), 0);
  LoadFile<Scenario>("pipe.yaml");
  EXPECT_EQ(Errors(), "pipe.yaml: is not a regular file");
  if (geteuid() != 0) {  // root may read everything
    fs::permissions(Put("secret.yaml", "{}"), fs::perms::none);
    LoadFile<Scenario>("secret.yaml");
    EXPECT_EQ(Errors(), "secret.yaml: cannot be read: Permission denied");
  }
  Put("file", "");
  LoadFile<Scenario>("file/a.yaml");
  EXPECT_EQ(Errors(), "file/a.yaml: does not exist");
}

TEST_F(ConfigTest, CarriageReturnsAloneAreNoLineEnds) {
  const std::string rule = "has a carriage return without a line feed; save it with the line ends of Unix or Windows";
  EXPECT_EQ(ErrorsOf("consist:\r  - vehicle: {mass_kg: 1}\r"), "a.yaml:1: " + rule);
  EXPECT_EQ(ErrorsOf("consist: []\r\n# a\rb\r\n"), "a.yaml:2: " + rule);
  ErrorList errors;
  ReadCsvTable(Put("old.csv", "time_s,pressure_kpa\r0,500\r"), errors);
  EXPECT_NE(errors.Text().find("old.csv:1: " + rule), std::string::npos) << errors.Text();
}

TEST_F(ConfigTest, TextsMayNotCommandTerminals) {
  for (const std::string escape : {"\\e[31m", "\\0", "\\a", "\\x7f", "\\x9b2J", "\\u202e", "\\u2066", "\\r"}) {
    const std::string errors = ErrorsOf("consist:\n  - vehicle: {name: \"a" + escape + "b\"}\n");
    EXPECT_NE(errors.find("a.yaml:2: consist[0].vehicle.name must be text without control characters, got 'a"),
              std::string::npos)
        << escape << ": " << errors;
    EXPECT_EQ(errors.find('\0'), std::string::npos) << "cut there by what takes C strings";
  }
  for (const std::string escape : {"\\n", "\\t", "\\xfc", "\\u00a0", "\\u202f", "$x_1$ # % \\U0001F682"})
    EXPECT_EQ(ErrorsOf("consist:\n  - vehicle: {name: \"a" + escape + "b\"}\n").find("control"), std::string::npos)
        << escape;
}

}  // namespace
}  // namespace strict_config
