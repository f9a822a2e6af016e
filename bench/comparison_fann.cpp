// SPDX-License-Identifier: MIT
// FANN's RPROP on the data and start weights that beamgyro_trainer prints:
// beamgyro_fann EPOCHS < data. One object per start: rms and processor time.
#include <doublefann.h>

#include <cmath>
#include <ctime>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace {

using nlohmann::json;

// Ours, W_1 column by column, b_1, W_2, b_2, by FANN's numbers of the neurons:
// inputs, their bias, hidden neurons, their bias, output.
void set_weights(fann* ann, unsigned inputs, unsigned hidden,
                 const std::vector<double>& w) {
  const unsigned last = inputs + 1 + hidden + 1;
  for (unsigned o = 0; o < hidden; ++o) {
    const unsigned to = inputs + 1 + o;
    for (unsigned i = 0; i <= inputs; ++i)
      fann_set_weight(ann, i, to, w[i * hidden + o]);
    fann_set_weight(ann, to, last, w[(inputs + 1) * hidden + o]);
  }
  fann_set_weight(ann, last - 1, last, w.back());
}

json train(const json& data, const std::vector<double>& w, int epochs) {
  const auto sizes = data["layer_sizes"].get<std::vector<unsigned>>();
  const auto inputs = data["inputs"].get<std::vector<std::vector<double>>>();
  const auto target = data["target"].get<std::vector<double>>();
  const auto count = static_cast<unsigned>(target.size());
  fann* ann = fann_create_standard_array(3, sizes.data());
  fann_train_data* rows = fann_create_train(count, sizes[0], 1);
  for (unsigned k = 0; k < count; ++k) {
    for (unsigned i = 0; i < sizes[0]; ++i) rows->input[k][i] = inputs[i][k];
    rows->output[k][0] = target[k];
  }
  // Its symmetric sigmoid of steepness s is tanh(s x).
  fann_set_activation_function_hidden(ann, FANN_SIGMOID_SYMMETRIC);
  fann_set_activation_function_output(ann, FANN_LINEAR);
  fann_set_activation_steepness_hidden(ann, 1.0);
  fann_set_activation_steepness_output(ann, 1.0);
  fann_set_train_error_function(ann, FANN_ERRORFUNC_LINEAR);
  fann_set_training_algorithm(ann, FANN_TRAIN_RPROP);
  set_weights(ann, sizes[0], sizes[1], w);
  const std::clock_t begin = std::clock();
  for (int epoch = 0; epoch < epochs; ++epoch) fann_train_epoch(ann, rows);
  const double took =
      static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  double squares = 0;
  for (unsigned k = 0; k < count; ++k) {
    const double e = *fann_run(ann, rows->input[k]) - target[k];
    squares += e * e;
  }
  fann_destroy_train(rows);
  fann_destroy(ann);
  return {{"rms", std::sqrt(squares / count)}, {"seconds", took}};
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::cerr << "usage: beamgyro_fann EPOCHS < data\n";
    return 2;
  }
  const json data = json::parse(std::cin);
  json results = json::array();
  for (const auto& w : data["weights"])
    results.push_back(train(data, w, std::stoi(argv[1])));
  std::cout << results.dump() << '\n';
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 1;
}
