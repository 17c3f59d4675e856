#include "strict_config/csv_table.h"

#include "config_test.h"

namespace strict_config {
namespace {

TEST_F(CsvTest, ReadsColumns) {
  const CsvTable table =
      ReadTable("\xEF\xBB\xBF# a comment\r\n\r\ntime_s, pressure_kpa\r\n0, 500\r\n# more\r\n 1e-1 ,4.5e2");
  EXPECT_EQ(Errors(), "");
  EXPECT_EQ(table.columns, (std::vector<std::string>{"time_s", "pressure_kpa"}));
  EXPECT_EQ(table.values, (std::vector<std::vector<double>>{{0.0, 0.1}, {500.0, 450.0}}));
  EXPECT_EQ(table.row_lines, (std::vector<int>{4, 6}));
  EXPECT_EQ(table.header_line, 3);
  EXPECT_EQ(table.Column("pressure_kpa", found), &table.values[1]);
  EXPECT_EQ(table.Column("pressure_pa", found), nullptr);
  EXPECT_EQ(Errors(), "t.csv:3: has no column pressure_pa; the column is pressure_kpa, in kPa");
}

TEST_F(CsvTest, ErrorsNameTheirLines) {
  EXPECT_EQ(ErrorsOfTable("time_s,pressure_kpa\n0\n1,2,3\nx,\n2,nan\n3,4 kPa\n4,5,6,\n"),
            "t.csv:2: has 1 values, but the header names 2 columns\n"
            "t.csv:3: has 3 values, but the header names 2 columns; decimals take a point, or a table "
            "another separator (';')\n"
            "t.csv:4: time_s must be a number, got 'x'\n"
            "t.csv:4: pressure_kpa must be a number, got nothing\n"
            "t.csv:5: pressure_kpa must be a finite number, got 'nan'\n"
            "t.csv:6: pressure_kpa must be a plain number in kPa (the unit is in the key), got '4 kPa'\n"
            "t.csv:7: has 4 values, but the header names 2 columns");
  EXPECT_EQ(ErrorsOfTable(""), "t.csv: is empty: a table begins with a line that names its columns");
  EXPECT_EQ(ErrorsOfTable("a,b\n"), "t.csv:1: names columns, but no line of numbers follows");
  EXPECT_EQ(ErrorsOfTable("a,,a,3\n1,2,3,4\n"),
            "t.csv:1: column 2 has no name\n"
            "t.csv:1: column a is given twice\n"
            "t.csv:1: must name the columns, got 3 for column 4");
  EXPECT_EQ(ErrorsOfTable(std::string(20000, ',')), "t.csv:1: has more than 10000 columns");
  EXPECT_EQ(ErrorsOfTable("a\n" + std::string(20000, ',')),
            "t.csv:2: has more than 10000 values, but the header names 1 columns");
  EXPECT_EQ(ErrorsOfTable(std::string("a\n\0", 3)), "t.csv:2: is not a text file (it contains a zero byte)");
  EXPECT_EQ(ErrorsOfTable("a,b\n\"1,2\n3,\"4\" 5\n"),
            "t.csv:2: has a quote that does not end, or text behind its end: \"1,2 (a quote within quotes is "
            "written twice)\n"
            "t.csv:3: has a quote that does not end, or text behind its end: \"4\" 5 (a quote within quotes is "
            "written twice)");
  ReadCsvTable((root / "none.csv").string(), found = ErrorList());
  EXPECT_EQ(Errors(), "none.csv: does not exist");
}

TEST_F(CsvTest, TakesWhatSpreadsheetsWrite) {
  const std::vector<std::vector<double>> expected = {{0.0, 0.1}, {500.0, -450.0}};
  const char* const texts[] = {
      "\"time_s\",\"pressure_kpa\"\n\"0\",500\n0.1, \"-450\" \n",  // quoted
      "time_s,pressure_kpa,\r\n0,500,\r\n0.1,-450,\r\n",           // closed by commas
      "time_s,pressure_kpa\n0,500,\n0.1,-450\n",                   // only some lines are
      "time_s;pressure_kpa\n0;500\n0.1;-450\n",                    // semicolons
      "\"time_s\"\t\"pressure_kpa\"\n0\t500\n0.1\t-450\n",         // tabs
      "time_s,pressure_kpa\n0,500\n,\n0.1,-450\n, \n,,\n\"\",\n",  // rows that were emptied
  };
  for (const char* const text : texts) {
    const CsvTable table = ReadTable(text);
    EXPECT_EQ(Errors(), "") << text;
    EXPECT_EQ(table.columns, (std::vector<std::string>{"time_s", "pressure_kpa"})) << text;
    EXPECT_EQ(table.values, expected) << text;
  }
  EXPECT_EQ(ReadTable("\"a, \"\"b\"\"\"\n1\n").columns, (std::vector<std::string>{"a, \"b\""}));
}

TEST_F(CsvTest, AListOfMapsMayBeATable) {
  Put("parts/brakes.csv", "reduction_kpa,note,time_s\n# pressures\n50,\"first, gently\",0\n,,12.5\n");
  const Scenario scenario =
      Read("consist: [{vehicle: {mass_kg: 1, coupler: {slack_m: 0}}}]\ncommands: parts/brakes.csv\n",
           {"commands[1].reduction_kpa=80"});
  ASSERT_EQ(scenario.commands.size(), 2U);
  EXPECT_EQ(scenario.commands[0].time_s, 0.0);
  EXPECT_EQ(scenario.commands[0].reduction_kpa, 50.0);
  EXPECT_EQ(scenario.commands[1].time_s, 12.5);
  EXPECT_EQ(scenario.commands[1].reduction_kpa, 80.0);
}

TEST_F(CsvTest, PartsInATableAreFoundFromTheTable) {
  Put("mine/vehicles/tank.yaml", "mass_kg: 7\ncoupler: {slack_m: 0.01}\n");
  Put("mine/consist.csv", "vehicle,count\ntank,3\n\"tank\",\n");
  const Scenario scenario = Read("consist: mine/consist.csv\n");
  ASSERT_EQ(scenario.consist.size(), 2U);
  EXPECT_EQ(scenario.consist[0].count, 3);
  EXPECT_EQ(scenario.consist[1].count, 1);
  EXPECT_EQ(scenario.consist[1].vehicle.mass_kg, 7.0);
}

TEST_F(CsvTest, ErrorsOfAListNameLineAndColumn) {
  const std::string consist = "consist: [{vehicle: {mass_kg: 1, coupler: {slack_m: 0}}}]\n";
  Put("c.csv", "time_s,reduction_kp\n0,50\nsoon,60\n-1,70\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"),
            "c.csv:1: commands[0].reduction_kp is not a known key; did you mean reduction_kpa?\n"
            "c.csv:3: commands[1].time_s must be a number, got 'soon'\n"
            "c.csv:4: commands[2].time_s must be >= 0, got -1");
  Put("c.csv", "reduction_kpa\n50\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"), "c.csv:2: commands[0].time_s is missing (must be >= 0)");
  EXPECT_EQ(ErrorsOf(consist + "commands: nowhere.csv\n"),
            "a.yaml:2: commands names the file 'nowhere.csv', but there is no nowhere.csv");
  Put("c.csv", "time_s\n");
  EXPECT_EQ(ErrorsOf(consist + "commands: c.csv\n"), "c.csv:1: names columns, but no row follows");
}

}  // namespace
}  // namespace strict_config
