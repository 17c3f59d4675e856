// The train over MPI, for comparison with the ROS graph: rank 0 is the master, the others have the vehicles. The
// exchange is the same - scatter of forces and pressures, one step, gather of coupler heads and, where one is due, of
// the record - and so is all the arithmetic, hence the digest. Energies and vehicles in detail are left out.
//
// usage: mpirun -n RANKS+1 mpi_train SCENARIO [PATH=VALUE ...]      prints JSON
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <exception>
#include <stdexcept>
#include <string>
#include <vector>

#include "train_dynamics/config/load_scenario.h"
#include "train_dynamics/train/ranks.h"
#include "train_dynamics/train/vehicle_block.h"

namespace train_dynamics {
namespace {

/// What every message is made of; a digest travels in the bits of one.
using Row = std::vector<double>;

/// Calls function(array) for each load of a list's array that is given always. The others have no place here.
template <class Loads, class Function>
void ForEachGivenLoad(Loads& loads, const Function& function) {
  ForEachLoad(
      [&](const LoadInfo& load, auto& array) {
        if (load.given == Given::kAlways) {
          function(array);
        } else if (!array.empty()) {
          throw std::invalid_argument(std::string("mpi_train does not carry ") + load.name);
        }
      },
      loads);
}

/// A request is what shall be done, the forces around the rank's vehicles and their other loads.
enum class Order { kEnd, kStep, kStepAndRecord };
int RequestSize(const Rank& rank) {
  int size = 1 + rank.count + 1;
  LoadArrays none;
  ForEachGivenLoad(none, [&](const Row&) { size += rank.count; });
  return size;
}

/// A reply is whether all is sound, what every exchange replies, and, with a record, that.
constexpr int kDigests = 1;
int ReplySize(const Rank& rank, bool record) {
  return 1 + rank.count * (kReplyNumbers + (record ? kRecordNumbers + kDigests : 0));
}

/// Calls copy(array of a reply, numbers of each vehicle) for all that a message holds.
template <class Copy>
void ForEachArray(ExchangeReply& reply, bool record, const Copy& copy) {
  const auto copy_field = [&](const RecordInfo& field, auto& array) { copy(array, field.numbers); };
  ForEachReplyField(copy_field, reply);
  if (!record) return;
  ForEachRecordField(copy_field, reply);
  copy(reply.state_digest, 1);
}

/// Where the ranks' parts of a message begin; rank 0, the master, has none.
struct Layout {
  template <class Size>
  Layout(const std::vector<Rank>& ranks, const Size& size) : sizes{0}, begins{0} {
    for (const Rank& rank : ranks) {
      begins.push_back(total);
      sizes.push_back(size(rank));
      total += sizes.back();
    }
  }
  std::vector<int> sizes, begins;
  int total = 0;
};

class MpiTransport : public Transport {
 public:
  explicit MpiTransport(const std::vector<Rank>& ranks)
      : ranks_(ranks),
        request_(ranks, RequestSize),
        reply_(ranks, [](const Rank& rank) { return ReplySize(rank, false); }),
        record_(ranks, [](const Rank& rank) { return ReplySize(rank, true); }),
        numbers_(request_.total) {}

  void Start(ExchangeReply& reply) override { Gather(true, reply); }
  void Resume(std::uint64_t, const std::vector<StateRow>&, ExchangeReply&) override {
    throw SnapshotError("cannot be taken up here: this train starts at time 0");
  }

  void Exchange(const ExchangeRequest& request, ExchangeReply& reply) override {
    double* to = numbers_.data();
    for (const Rank& rank : ranks_) {
      *to++ = static_cast<double>(request.record ? Order::kStepAndRecord : Order::kStep);
      to = std::copy_n(&request.coupler_force_n[rank.first], rank.count + 1, to);
      ForEachGivenLoad(request, [&](const Row& array) { to = std::copy_n(&array[rank.first], rank.count, to); });
    }
    Scatter();
    Gather(request.record, reply);
  }

  void End() {
    for (std::size_t i = 1; i < request_.begins.size(); ++i) {
      numbers_[request_.begins[i]] = static_cast<double>(Order::kEnd);
    }
    Scatter();
  }

 private:
  void Scatter() {
    MPI_Scatterv(numbers_.data(), request_.sizes.data(), request_.begins.data(), MPI_DOUBLE, nullptr, 0, MPI_DOUBLE, 0,
                 MPI_COMM_WORLD);
  }

  void Gather(bool record, ExchangeReply& reply) {
    const Layout& layout = record ? record_ : reply_;
    Row replies(layout.total);
    MPI_Gatherv(nullptr, 0, MPI_DOUBLE, replies.data(), layout.sizes.data(), layout.begins.data(), MPI_DOUBLE, 0,
                MPI_COMM_WORLD);
    const double* from = replies.data();
    for (const Rank& rank : ranks_) {
      if (*from++ != 1.0) reply.fault = {rank.first, "has left the domain of the laws, or one behind it"};
      ForEachArray(reply, record, [&](auto& array, int numbers) {
        std::memcpy(&array[rank.first * numbers], from, rank.count * numbers * sizeof(double));
        from += rank.count * numbers;
      });
    }
  }

  std::vector<Rank> ranks_;
  Layout request_, reply_, record_;
  Row numbers_;
};

void RunMaster(const config::LoadedScenario& scenario, const std::vector<Rank>& ranks) {
  MpiTransport transport(ranks);
  TrainMaster master(scenario.params, scenario.consist, transport, scenario.pressures);
  master.Start();
  const auto begin = std::chrono::steady_clock::now();
  while (!master.Done()) master.Exchange();
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  transport.End();
  std::printf("{\"ranks\": %zu, \"exchanges\": %" PRIu64 ", \"wall_s\": %.9g, \"state_digest\": \"%016" PRIx64 "\"}\n",
              ranks.size(), master.exchange(), wall.count(), master.state_digest());
}

void RunVehicles(const config::LoadedScenario& scenario, const Rank& rank) {
  const auto block = MakeVehicleBlock(scenario.params, scenario.consist, rank.first, rank.count);
  ExchangeReply reply(rank.count, {});
  ExchangeRequest request;
  request.dt_s = scenario.params.dt_s;
  request.steps = scenario.params.StepsPerExchange();
  Row numbers;
  const auto send = [&](bool sound, bool record) {
    numbers = {sound ? 1.0 : 0.0};
    ForEachArray(reply, record, [&](const auto& array, int) {
      numbers.resize(numbers.size() + array.size());
      std::memcpy(&*numbers.end() - array.size(), array.data(), array.size() * sizeof(double));
    });
    MPI_Gatherv(numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, nullptr, nullptr, nullptr, MPI_DOUBLE, 0,
                MPI_COMM_WORLD);
  };
  block->Report(0, false, reply);
  send(true, true);
  while (true) {
    numbers.resize(RequestSize(rank));
    MPI_Scatterv(nullptr, nullptr, nullptr, MPI_DOUBLE, numbers.data(), static_cast<int>(numbers.size()), MPI_DOUBLE, 0,
                 MPI_COMM_WORLD);
    const auto order = static_cast<Order>(numbers[0]);
    if (order == Order::kEnd) return;
    request.record = order == Order::kStepAndRecord;
    auto from = numbers.begin() + 1;
    const auto take = [&](Row& array, int count) {
      array.assign(from, from + count);
      from += count;
    };
    take(request.coupler_force_n, rank.count + 1);
    ForEachGivenLoad(request, [&](Row& array) { take(array, rank.count); });
    const bool sound = block->Advance(request, 0, reply);
    send(sound, request.record);
  }
}

}  // namespace
}  // namespace train_dynamics

int main(int argc, char** argv) {
  using namespace train_dynamics;
  MPI_Init(&argc, &argv);
  int processes = 0, process = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &processes);
  MPI_Comm_rank(MPI_COMM_WORLD, &process);
  try {
    if (argc < 2 || processes < 2)
      throw std::invalid_argument("usage: mpirun -n RANKS+1 mpi_train SCENARIO [PATH=VALUE ...]");
    const auto scenario = config::LoadScenario(argv[1], std::vector<std::string>(argv + 2, argv + argc));
    const std::vector<Rank> ranks = SplitRanks(scenario.consist.vehicles(), processes - 1);
    if (static_cast<int>(ranks.size()) != processes - 1) throw std::invalid_argument("more ranks than vehicles");
    if (process == 0) {
      RunMaster(scenario, ranks);
    } else {
      RunVehicles(scenario, ranks[process - 1]);
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "mpi_train: %s\n", e.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return 0;
}
